/// Blocks, archives, objects, declarations.
#include <cstdint>

#include "pipeline/rib/reader/block_ends.h"
#include "pipeline/rib/reader/motion_collector.h"
#include "pipeline/rib/reader/open_files.h"
#include "pipeline/rib/reader/request_stream.h"
#include "pipeline/rib/reader/scene_builder.h"
#include "pipeline/rib/requests/request_table.h"

namespace trapeze::rib {
namespace {

/// The version of RIB; all are read alike.
void version(StructureContext&, ArgumentCursor& c) {
    c.number("the version");
}

/// Replaces what the name meant, RISpec's own included.
void declare(StructureContext& r, ArgumentCursor& c) {
    const std::string name = c.string("the name"), text = c.string("the declaration");
    if (text.empty()) return r.state.declarations().forget(name);  // as Liquid and others write it
    const auto declaration = parse_declaration(text);
    if (!declaration) throw RequestError{in_quotes(text) + " is no declaration", {}};
    r.state.declarations().declare(name, *declaration);
}

/// FrameBegin number: any integer; frames need not be in order.
void frame_begin(StructureContext& r, ArgumentCursor& c) {
    r.scene.begin_frame(c.integer("the frame's number", INT32_MIN, INT32_MAX));
}

/// WorldBegin: from here on options stand, and the current space is named "world".
void world_begin(StructureContext& r, ArgumentCursor&) {
    r.scene.begin_world();
    r.files.begin_world();
}

/// The times stand in an array, in older files without brackets.
void motion_begin(StructureContext& r, ArgumentCursor& c) {
    std::vector<float> times = c.number_array("the times");
    while (c.next_is_number()) times.push_back(c.number("a time"));
    r.motion.begin(std::move(times));
}

/// Parameters are PRMan's, and are read past.
void read_archive(StructureContext& r, ArgumentCursor& c) {
    const std::string name = c.string("the archive's name");
    r.parameters(c, Undeclared::Guess);
    r.stream.read_archive(name);
}

/// Parameters are later renderers', and set variables of the instance there.
void object_instance(StructureContext& r, ArgumentCursor& c) {
    const std::string handle = c.handle("the handle");
    if (!r.parameters(c, Undeclared::Guess).values.empty())
        r.report.warn_once("parameters are not used", "instance-parameters");
    r.scene.instance(handle);
}

/// Requests that make the order of a file: no motion block holds them back.
constexpr RequestRow kStructureRequests[] = {
    {"version", version},
    {"Declare", declare},
    {"FrameBegin", frame_begin},
    {"FrameEnd", [](StructureContext& r, ArgumentCursor&) { r.blocks.end(BlockKind::Frame); }},
    {"WorldBegin", world_begin},
    {"WorldEnd", [](StructureContext& r, ArgumentCursor&) { r.blocks.end(BlockKind::World); }},
    {"AttributeBegin",
     [](StructureContext& r, ArgumentCursor&) { r.state.open(BlockKind::Attribute, r.report.at()); }},
    {"AttributeEnd", [](StructureContext& r, ArgumentCursor&) { r.blocks.end(BlockKind::Attribute); }},
    {"TransformBegin",
     [](StructureContext& r, ArgumentCursor&) { r.state.open(BlockKind::Transform, r.report.at()); }},
    {"TransformEnd", [](StructureContext& r, ArgumentCursor&) { r.blocks.end(BlockKind::Transform); }},
    {"MotionBegin", motion_begin},
    {"MotionEnd", [](StructureContext& r, ArgumentCursor&) { r.blocks.end(BlockKind::Motion); }},
    {"ReadArchive", read_archive},
    {"ArchiveBegin", [](StructureContext&, ArgumentCursor&) { /* read as text before it gets here */ }},
    {"ArchiveEnd",
     [](StructureContext& r, ArgumentCursor&) { r.report.error("no ArchiveBegin is open; ignored"); }},
    {"ObjectBegin",
     [](StructureContext& r, ArgumentCursor& c) { r.scene.begin_object(c.handle("the handle")); }},
    {"ObjectEnd", [](StructureContext& r, ArgumentCursor&) { r.blocks.end(BlockKind::Object); }},
    {"ObjectInstance", object_instance},
};

}  // namespace

std::span<const RequestRow> structure_requests() {
    return kStructureRequests;
}

}  // namespace trapeze::rib
