/// The parts of the reader, put together for one reading.
///
///     RequestStream -> RequestExecutor -> a handler (requests/) -> GraphicsStateStack
///                                                               -> MotionCollector -> GraphicsStateStack
///                                                               -> SceneBuilder    -> on_world
#include "pipeline/rib/read_rib.h"
#include "pipeline/rib/reader/block_ends.h"
#include "pipeline/rib/reader/conditional_blocks.h"
#include "pipeline/rib/reader/file_search.h"
#include "pipeline/rib/reader/motion_collector.h"
#include "pipeline/rib/reader/open_files.h"
#include "pipeline/rib/reader/procedurals.h"
#include "pipeline/rib/reader/request_executor.h"
#include "pipeline/rib/reader/request_report.h"
#include "pipeline/rib/reader/request_stream.h"
#include "pipeline/rib/reader/scene_builder.h"
#include "pipeline/rib/state/graphics_state_stack.h"

namespace trapeze {
namespace {

/// Each part knows those above it by reference; the executor and the stream, which need one another, know
/// each other before they are made.
struct RibReader {
    RibReader(const ReadOptions& options, Diagnostics& diagnostics,
              const rib::SceneBuilder::OnWorld& on_world)
        : access(options.access ? *options.access : everything),
          report(diagnostics, options.cancelled),
          search(access, report, state, files),
          motion(report, state),
          conditions(report, state, access),
          scene(options, report, state, motion, place, search, on_world),
          blocks(report, state, motion, scene, executor),
          stream(options, access, report, files, search, conditions, place, executor),
          procedurals(options, access, report, state, scene, blocks, files, search, stream),
          contexts(rib::RequestContext(report, state), rib::StateContext(report, state),
                   rib::OptionContext{{report, state}, files, search},
                   rib::TransformContext{{report, state}, motion}, rib::LightContext({report, state}, scene),
                   rib::GeometryContext({report, state}, scene), rib::MapContext({report, state}, scene),
                   rib::StructureContext{{report, state}, motion, scene, blocks, files, stream},
                   rib::ConditionalContext{{report, state}, conditions},
                   rib::ProceduralContext{{report, state}, procedurals}),
          executor(options, report, motion, conditions, scene, contexts) {}
    RibReader(const RibReader&) = delete;
    RibReader& operator=(const RibReader&) = delete;

    // The report's summary is taken out of it: nothing may be read afterwards.
    ReadSummary finish() {
        if (!report.has_stopped()) {  // else what is open is not delivered
            blocks.end_all();
            scene.report_turned_away();
        }
        return std::move(report.summary());
    }

    // The order of the members is that of their making, each after those that it needs; `everything` stands
    // in where the caller has set no limits.
    Access everything;
    Access& access;
    rib::RequestReport report;
    rib::OpenFiles files;
    rib::ArchivePlace place;
    rib::GraphicsStateStack state;
    rib::FileSearch search;
    rib::MotionCollector motion;
    rib::ConditionalBlocks conditions;
    rib::SceneBuilder scene;
    rib::BlockEnds blocks;
    rib::RequestStream stream;
    rib::Procedurals procedurals;
    rib::RequestContexts contexts;
    rib::RequestExecutor executor;
};

}  // namespace

/// The user's own texts come first and are trusted: the folders that they name for searching are open to the
/// scene, while those that the scene names are not.
ReadSummary read_rib(std::span<const std::string> files, const ReadOptions& options, Diagnostics& diagnostics,
                     const std::function<void(Scene&&)>& on_world) {
    RibReader reader(options, diagnostics, on_world);
    reader.search.set_trusted(true);
    if (!options.defaults_file.empty()) reader.stream.read_file(options.defaults_file, kEverything);
    for (const ReadOptions::Text& text : options.first_texts) reader.stream.read_memory(text.rib, text.name);
    reader.search.set_trusted(false);
    for (const std::string& file : files) reader.stream.read_file(file, kEverything);
    return reader.finish();
}

ReadSummary read_rib_text(std::string_view text, const std::string& name, const ReadOptions& options,
                          Diagnostics& diagnostics, const std::function<void(Scene&&)>& on_world) {
    RibReader reader(options, diagnostics, on_world);
    reader.stream.read_memory(text, name);
    return reader.finish();
}

}  // namespace trapeze
