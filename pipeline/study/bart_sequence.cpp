#include "pipeline/study/bart_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <tuple>

#include "pipeline/study/aff/aff_scene.h"

namespace trapeze {
namespace {

constexpr int kFramesQuick = 11, kFrames = 31;

/// Turns places of the world to those that a camera sees: x to its right, y up, z away from it.
class CameraSpace {
  public:
    explicit CameraSpace(const AffCamera& camera) : from_(camera.from) {
        away_ = (camera.at - camera.from).normalized();
        right_ = away_.cross(camera.up).normalized();  // the world is right-handed
        up_ = right_.cross(away_);
    }
    V3f operator()(const V3f& world) const {
        const V3f to = world - from_;
        return {to.dot(right_), to.dot(up_), to.dot(away_)};
    }

  private:
    V3f from_, away_, right_, up_;
};

/// A grid for each triangle, a quad whose last two corners are one.
Grids grids_of(const std::vector<V3f>& corners, const CameraSpace& space) {
    Grids grids;
    GridArena& arena = grids.arenas.emplace_back();
    grids.grids.reserve(corners.size() / 3);
    for (size_t t = 0; t + 2 < corners.size(); t += 3) {
        Grid& grid = grids.grids.emplace_back();
        grid.ordinal = t / 3;
        arena.allocate(grid);
        std::fill_n(grid.half_colors(), grid.color_count(), Imath::half(1.0f));
        for (int j = 0; j < 4; ++j)
            for (int i = 0; i < 4; ++i) {
                const V3f corner = space(corners[t + static_cast<size_t>(j > 0 ? 2 : i > 0 ? 1 : 0)]);
                for (int k = 0; k < 3; ++k) grid.plane(0, k)[grid.shape.tiled_index(i, j)] = corner[k];
            }
    }
    return grids;
}

/// The triangles that are not where they were.
std::vector<uint32_t> changed_between(const std::vector<V3f>& before, const std::vector<V3f>& now) {
    std::vector<uint32_t> changed;
    for (size_t t = 0; 3 * t < now.size(); ++t)
        if (std::memcmp(&before[3 * t], &now[3 * t], 3 * sizeof(V3f)) != 0)
            changed.push_back(static_cast<uint32_t>(t));
    return changed;
}

void note_facts(const BartScene& scene, const AffScene& file, const BartFrames& frames, int first,
                StudyResult& result) {
    StudySceneFacts& facts = result.scenes.emplace_back();
    facts.label = scene.label;
    facts.command = fmt::format("{}, frames {} to {} of {}", scene.file, first,
                                first + static_cast<int>(frames.grids.size()) - 1, file.frame_count());
    facts.width = scene.width, facts.height = scene.height;
    facts.micropolygons = facts.grids = frames.grids.front().grids.size();
    size_t moves = 0;
    for (const std::vector<uint32_t>& changed : frames.sequence.changed) moves += changed.size();
    result.notes.push_back(fmt::format(
        "{}: {} triangles, of which {} move in a frame (mean of {}); the camera stands still.", scene.label,
        facts.micropolygons, moves / (frames.grids.size() - 1), frames.grids.size() - 1));
}

}  // namespace

std::unique_ptr<BartFrames> bart_frames(StudyBench& bench, const BartScene& scene, StudyResult& result) {
    bench.go_on();
    bench.stage(fmt::format("reading {}", scene.file));
    std::string problem;
    const auto file = AffScene::read(bench.bart_folder() + "/" + scene.file, &problem);
    if (!file || file->frame_count() < 2) {
        result.notes.push_back(
            fmt::format("{} is not followed: {}", scene.label, file ? "it has no frames" : problem));
        return {};
    }
    const int count = std::min(file->frame_count(), bench.quick() ? kFramesQuick : kFrames),
              first = (file->frame_count() - count) / 2;
    const auto time_of = [&](int frame) {
        return file->first_time() +
               (file->last_time() - file->first_time()) * frame / (file->frame_count() - 1);
    };
    const AffCamera camera = file->camera_at(time_of(first + count / 2));
    auto frames = std::make_unique<BartFrames>();
    std::tie(frames->scene, frames->context) = bench.empty_scene(fmt::format(
        "Format {} {} 1 PixelSamples 1 1 PixelFilter \"box\" 1 1 Clipping {} 1e6 Projection \"perspective\" \"fov\" [{}] "
        "WorldBegin WorldEnd",
        scene.width, scene.height, std::max(1e-3f, camera.hither), camera.angle));
    const CameraSpace space(camera);
    std::vector<V3f> before;
    for (int frame = 0; frame < count; ++frame) {
        bench.go_on();
        std::vector<V3f> now = file->triangles_at(time_of(first + frame));
        frames->grids.push_back(grids_of(now, space));
        frames->sequence.changed.push_back(frame == 0 ? std::vector<uint32_t>{}
                                                      : changed_between(before, now));
        before = std::move(now);
    }
    frames->sequence.label = scene.label;
    frames->sequence.context = &frames->context;
    frames->sequence.pixels = sampled_pixels(frames->context.camera, frames->scene->options);
    for (const Grids& grids : frames->grids) frames->sequence.frames.push_back(&grids);
    note_facts(scene, *file, *frames, first, result);
    return frames;
}

}  // namespace trapeze
