/// Blocks, archives, objects, declarations.
#include <cstdint>

#include "pipeline/rib/requests/request_table.h"

namespace trapeze::rib {
namespace {

void version(Reader&, ArgumentCursor& c) {
    c.number("the version");
}

void declare(Reader& r, ArgumentCursor& c) {
    const std::string name = c.string("the name"), text = c.string("the declaration");
    if (text.empty()) return r.declarations().forget(name);  // as Liquid and others write it
    const auto declaration = parse_declaration(text);
    if (!declaration) throw RequestError{in_quotes(text) + " is no declaration", {}};
    r.declarations().declare(name, *declaration);
}

void frame_begin(Reader& r, ArgumentCursor& c) {
    r.begin_frame(c.integer("the frame's number", INT32_MIN, INT32_MAX));
}

void motion_begin(Reader& r, ArgumentCursor& c) {
    std::vector<float> times = c.number_array("the times");
    while (c.next_is_number()) times.push_back(c.number("a time"));
    r.begin_motion(std::move(times));
}

void read_archive(Reader& r, ArgumentCursor& c) {
    const std::string name = c.string("the archive's name");
    r.parameters(c, Undeclared::Guess);
    r.read_archive(name);
}

constexpr RequestRow kStructureRequests[] = {
    {"version", version},
    {"Declare", declare},
    {"FrameBegin", frame_begin},
    {"FrameEnd", [](Reader& r, ArgumentCursor&) { r.end_block(Block::Frame); }},
    {"WorldBegin", [](Reader& r, ArgumentCursor&) { r.begin_world(); }},
    {"WorldEnd", [](Reader& r, ArgumentCursor&) { r.end_block(Block::World); }},
    {"AttributeBegin", [](Reader& r, ArgumentCursor&) { r.begin_block(Block::Attribute); }},
    {"AttributeEnd", [](Reader& r, ArgumentCursor&) { r.end_block(Block::Attribute); }},
    {"TransformBegin", [](Reader& r, ArgumentCursor&) { r.begin_block(Block::Transform); }},
    {"TransformEnd", [](Reader& r, ArgumentCursor&) { r.end_block(Block::Transform); }},
    {"MotionBegin", motion_begin},
    {"MotionEnd", [](Reader& r, ArgumentCursor&) { r.end_block(Block::Motion); }},
    {"ReadArchive", read_archive},
    {"ArchiveBegin", [](Reader&, ArgumentCursor&) { /* read as text before it gets here */ }},
    {"ArchiveEnd", [](Reader& r, ArgumentCursor&) { r.error("no ArchiveBegin is open; ignored"); }},
    {"ObjectBegin", [](Reader& r, ArgumentCursor& c) { r.begin_object(c.handle("the handle")); }},
    {"ObjectEnd", [](Reader& r, ArgumentCursor&) { r.end_block(Block::Object); }},
    {"ObjectInstance", [](Reader& r, ArgumentCursor& c) { r.instance(c.handle("the handle")); }},
};

}  // namespace

std::span<const RequestRow> structure_requests() {
    return kStructureRequests;
}

}  // namespace trapeze::rib
