/// Reads RIB into Scenes: the border at which everything is validated.
///
/// Requests not supported are skipped whole, with one warning of each kind. What is wrong is reported as
/// `file:line:col: error: Request: what is wrong; what was done`, and reading goes on at the next request.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/diagnostics.h"
#include "core/files/access.h"
#include "core/scene/scene.h"
#include "pipeline/rib/map_request.h"

namespace trapeze {

namespace rib {
struct RequestText;
}

/// What a reading may use and reach, and whom it tells as it goes on. Functions are called within the
/// reading, by its own thread; borrowed pointers outlive it.
struct ReadOptions {
    std::optional<float> shading_rate;  ///< instead of every ShadingRate
    std::function<bool(int)>
        wants_frame;  ///< worlds of other FrameBegin blocks are not delivered; empty: all
    /// Called where the file asks for a map, between worlds in the order of the file; not in frames that are
    /// not wanted. Empty: maps are not made.
    std::function<void(const MapRequest&)> on_map;
    /// RIB that is executed before the files; messages name them so. What their options and attributes say
    /// holds until the files say otherwise.
    struct Text {
        std::string name, rib;
    };
    std::vector<Text> first_texts;
    std::string defaults_file;  ///< read before those and the files; empty: none

    /// What the files may reach, else everything. Folders that `defaults_file` and `first_texts` search are
    /// opened to the files; `files` and `defaults_file` themselves are read wherever they are.
    Access* access = nullptr;

    bool allow_programs = false;  ///< Procedural "RunProgram" and "DynamicLoad" run what the file names
    /// A command that loads the library which is its last word, and answers as programs do; empty: there is
    /// no "DynamicLoad".
    std::vector<std::string> procedural_host;
    double program_seconds = 10;  ///< a program that says nothing for so long does not answer
    /// Called each second of which a program says nothing, with its name and how many there have been.
    std::function<void(const std::string&, int)> on_wait;

    /// Called for each known request whose arguments can be read, whether it is supported or not, in the
    /// order in which they are carried out: conditional blocks are resolved, and the requests of an archive
    /// come where it is read, after the ReadArchive (or between an AttributeBegin and an AttributeEnd after a
    /// Procedural). False: the request is not carried out. May be empty.
    std::function<bool(const rib::RequestText&)> on_request;
    /// on_request is told of ArchiveBegin, ArchiveEnd and all that stands in between, too, as it stands
    /// there; what it answers means nothing then.
    bool tells_archives = false;
    const std::atomic<bool>* cancelled = nullptr;  ///< ends the reading; no further world is delivered

    bool keep_geometry = true;                  ///< false: primitives are validated and counted, not kept
    size_t max_source_bytes = size_t{8} << 30;  ///< of any one file, unpacked

    // Small files can ask for much: archives that read archives, objects with many instances.
    uint64_t most_archives_read = uint64_t{1} << 20;
    uint64_t most_bytes_read = uint64_t{64} << 30;           ///< of all files and inline archives
    uint64_t most_instanced_primitives = uint64_t{1} << 24;  ///< of a world
    uint64_t most_scene_bytes = uint64_t{1} << 40;           ///< of a world's primitives in memory, about
};

/// What was in the input.
struct ReadSummary {
    std::map<std::string, uint64_t> requests;     ///< all known ones, by name
    std::map<std::string, uint64_t> unsupported;  ///< known but skipped
    /// Understood, but nothing looks at them: requests, and `Option "limits" "eyesplits"`.
    std::map<std::string, uint64_t> without_effect;
    /// Need no effect, and why: `Attribute "stitch" "enable": grids join without cracks in any case`.
    std::map<std::string, uint64_t> not_needed;
    std::map<std::string, uint64_t> primitives;  ///< by request, those that were valid
    std::map<std::string, uint64_t> shaders;     ///< by kind and name: "surface plastic"
    uint64_t points = 0, faces = 0;              ///< control points and faces of those primitives
    uint64_t moving_primitives = 0, lights = 0;
    uint64_t bytes = 0;  ///< unpacked, archives as often as they are read
    int files = 0, frames = 0, worlds = 0;
};

/// Reads the files ("-": standard input) one after another as one stream; calls on_world at the end of each
/// world.
ReadSummary read_rib(std::span<const std::string> files, const ReadOptions& options, Diagnostics& diagnostics,
                     const std::function<void(Scene&&)>& on_world);

/// Reads a text as read_rib() reads a file; messages name it `name`. Relative names in it are looked for in
/// the current folder.
ReadSummary read_rib_text(std::string_view text, const std::string& name, const ReadOptions& options,
                          Diagnostics& diagnostics, const std::function<void(Scene&&)>& on_world);

}  // namespace trapeze
