#include "pipeline/study/aff/aff_parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>

#include "core/files/access.h"
#include "pipeline/study/aff/aff_keyframes.h"
#include "pipeline/study/aff/aff_shapes.h"
#include "pipeline/study/aff/aff_words.h"

namespace trapeze {
namespace {

// Limits for strangers' files. BART's kitchen has 110,561 triangles, 187 files and 6 MB.
constexpr size_t kMostAffTriangles = 4'000'000;
constexpr size_t kMostAffBytes = size_t{1} << 28;  ///< of all files, each as often as it is included
constexpr int kMostAffFiles = 20'000;              ///< that are included, each as often as it is
constexpr int kMostAffIncludes = 16;               ///< in each other
constexpr int kMostAffDepth = 64;                  ///< of transforms in each other
constexpr size_t kMostAffTransforms = 200'000;
constexpr int kAnyCount = std::numeric_limits<int>::max();  ///< the file's end will tell

class AffParser {
  public:
    AffParser(AffContents* contents, std::string* problem) : contents_(*contents), problem_(*problem) {}

    void read_root(const std::string& path) {
        AffWords nowhere(path, {}, problem_);
        if (const auto text = fetch(nowhere, path, path)) read_text(path, *text);
        if (!problem_.empty()) return;
        if (const auto camera = animations_.find("camera"); camera != animations_.end())
            contents_.camera_animation = camera->second;
        if (!contents_.transforms.animate(animations_))
            nowhere.fail("too many visibility keys in transforms that are in each other");
    }

  private:
    using Statement = void (AffParser::*)(AffWords&);
    static Statement statement_of(std::string_view word);

    /// A file's text; where there is none, it fails where `words` are, for a file that is `shown` so.
    std::optional<std::string> fetch(AffWords& words, const std::string& path, std::string_view shown);
    void read_text(const std::string& path, std::string_view text);

    void add_triangle(AffWords& words, const V3f& a, const V3f& b, const V3f& c);
    void add_triangles(AffWords& words, const std::vector<AffTriangle>& triangles);
    void begin_transform(AffWords& words, int transform);

    void view(AffWords& words);
    void animation_times(AffWords& words);
    void detail_level(AffWords& words) { detail_ = words.integer("a level of detail", 0, kAnyCount); }
    void include(AffWords& words);
    void keyframes(AffWords& words);
    void animated_transform(AffWords& words);
    void static_transform(AffWords& words);
    void end_transform(AffWords& words);

    void polygon(AffWords& words) { polygon_with(words, 0); }
    void polygon_patch(AffWords& words) { polygon_with(words, 3); }
    void polygon_with(AffWords& words, int more_numbers);
    void textured_triangle(AffWords& words) { textured_triangle_with(words, 2); }
    void textured_patch(AffWords& words) { textured_triangle_with(words, 5); }
    void textured_triangle_with(AffWords& words, int more_numbers);
    void moving_triangle(AffWords& words);
    void mesh(AffWords& words);
    void sphere(AffWords& words);
    void cone(AffWords& words);

    void light(AffWords& words);
    void animated_light(AffWords& words) {
        words.word("a light's name");
        light(words);
    }
    void color(AffWords& words) { words.skip_numbers(3, "a colour"); }
    void fill(AffWords& words) { words.skip_numbers(8, "a material"); }
    void fill_material(AffWords& words) { words.skip_numbers(12, "a material"); }

    /// A transform whose brace is open.
    struct Open {
        int transform, line;
    };

    AffContents& contents_;
    std::string& problem_;
    AffAnimations animations_;
    std::vector<Open> open_{{0, 0}};  ///< the world first
    size_t open_before_file_ = 1;     ///< those of open_ that the file at hand may not close
    int detail_ = 0, includes_ = 0, files_ = 0;
    size_t bytes_ = 0;
};

AffParser::Statement AffParser::statement_of(std::string_view word) {
    static constexpr std::pair<std::string_view, Statement> kStatements[] = {
        {"v", &AffParser::view},
        {"a", &AffParser::animation_times},
        {"d", &AffParser::detail_level},
        {"i", &AffParser::include},
        {"k", &AffParser::keyframes},
        {"x", &AffParser::animated_transform},
        {"xs", &AffParser::static_transform},
        {"}", &AffParser::end_transform},
        {"p", &AffParser::polygon},
        {"pp", &AffParser::polygon_patch},
        {"tt", &AffParser::textured_triangle},
        {"ttp", &AffParser::textured_patch},
        {"tpa", &AffParser::moving_triangle},
        {"m", &AffParser::mesh},
        {"s", &AffParser::sphere},
        {"c", &AffParser::cone},
        {"l", &AffParser::light},
        {"la", &AffParser::animated_light},
        {"b", &AffParser::color},
        {"am", &AffParser::color},
        {"f", &AffParser::fill},
        {"fm", &AffParser::fill_material},
    };
    const auto found = std::ranges::find(kStatements, word, &std::pair<std::string_view, Statement>::first);
    return found == std::end(kStatements) ? nullptr : found->second;
}

std::optional<std::string> AffParser::fetch(AffWords& words, const std::string& path,
                                            std::string_view shown) {
    std::string text;
    if (++files_ > kMostAffFiles) {
        words.fail(fmt::format("more than {} files", kMostAffFiles));
    } else if (!kEverything.read(path, kMostAffBytes - bytes_, &text)) {
        words.fail_on(kEverything.has_file(path) ? "not permitted, or all files together are too large:"
                                                 : "no such file:",
                      shown);
    } else {
        bytes_ += text.size();
        return text;
    }
    return {};
}

void AffParser::read_text(const std::string& path, std::string_view text) {
    AffWords words(path, text, problem_);
    const size_t before = std::exchange(open_before_file_, open_.size());
    while (!words.at_end()) {
        const std::string_view word = words.word("a statement");
        if (const Statement statement = statement_of(word))
            (this->*statement)(words);
        else
            words.fail_on("no statement of AFF", word);
    }
    if (open_.size() > open_before_file_)
        words.fail(fmt::format("the transform of line {} has no }}", open_.back().line));
    open_before_file_ = before;
}

void AffParser::add_triangle(AffWords& words, const V3f& a, const V3f& b, const V3f& c) {
    const size_t triangle = contents_.corners.size() / 3;
    if (triangle >= kMostAffTriangles) words.fail(fmt::format("more than {} triangles", kMostAffTriangles));
    if (words.failed()) return;
    contents_.corners.insert(contents_.corners.end(), {a, b, c});
    std::vector<AffRun>& runs = contents_.runs;
    if (runs.empty() || runs.back().transform != open_.back().transform)
        runs.push_back({open_.back().transform, triangle, triangle});
    runs.back().end = triangle + 1;
}

void AffParser::add_triangles(AffWords& words, const std::vector<AffTriangle>& triangles) {
    for (const AffTriangle& t : triangles) add_triangle(words, t[0], t[1], t[2]);
}

void AffParser::view(AffWords& words) {
    AffCamera camera;
    words.expect("from");
    camera.from = V3f(words.vector("a place"));
    words.expect("at");
    camera.at = V3f(words.vector("a place"));
    words.expect("up");
    camera.up = V3f(words.vector("a direction"));
    words.expect("angle");
    camera.angle = static_cast<float>(words.number("an angle"));
    words.expect("hither");
    camera.hither = static_cast<float>(words.number("a distance"));
    if (camera.hither < 1e-4f) camera.hither = 1;  // so does BART
    words.expect("resolution");
    camera.width = words.integer("a width in pixels", 1, 1 << 16);
    camera.height = words.integer("a height in pixels", 1, 1 << 16);
    contents_.camera = camera;
}

void AffParser::animation_times(AffWords& words) {
    contents_.first_time = words.number("the time of the first frame");
    contents_.last_time = words.number("the time of the last frame");
    contents_.frames = words.integer("a count of frames", 1, kAnyCount);
    if (contents_.last_time < contents_.first_time) words.fail("the last frame is before the first one");
}

void AffParser::include(AffWords& words) {
    const int level = words.integer("a level of detail", 0, kAnyCount);
    const std::string name(words.word("a file's name"));
    if (words.failed() || level > detail_) return;
    if (includes_ == kMostAffIncludes)
        return words.fail(fmt::format("files include each other {} deep", kMostAffIncludes));
    const std::string path = (std::filesystem::path(words.name()).parent_path() / name).string();
    const std::optional<std::string> text = fetch(words, path, name);
    if (!text) return;
    ++includes_;
    read_text(path, *text);
    --includes_;
}

void AffParser::keyframes(AffWords& words) {
    const std::string name(words.word("a transform's name"));
    // A later one of the name takes the place of this, wherever they are.
    animations_[name] = read_keyframes(words);
}

void AffParser::begin_transform(AffWords& words, int transform) {
    words.expect("{");
    if (contents_.transforms.size() > kMostAffTransforms ||
        contents_.transforms.depth(transform) > kMostAffDepth)
        words.fail(fmt::format("more than {} transforms, or more than {} in each other", kMostAffTransforms,
                               kMostAffDepth));
    open_.push_back({transform, words.line()});
}

void AffParser::animated_transform(AffWords& words) {
    const std::string name(words.word("a transform's name"));
    begin_transform(words, contents_.transforms.add_animated(open_.back().transform, name));
}

void AffParser::static_transform(AffWords& words) {
    const V3d scale = words.vector("a scale"), axis = words.vector("an axis");
    const double degrees = words.number("an angle");
    const V3d translation = words.vector("a translation");
    // Scales first: points are rows.
    const M44d matrix = M44d().setScale(scale) * aff_rotation(axis, degrees).toMatrix44() *
                        M44d().setTranslation(translation);
    begin_transform(words, contents_.transforms.add_static(open_.back().transform, matrix));
}

void AffParser::end_transform(AffWords& words) {
    if (open_.size() > open_before_file_)
        open_.pop_back();
    else
        words.fail("} without a transform of this file that is open");
}

void AffParser::polygon_with(AffWords& words, int more_numbers) {
    const int count = words.integer("a count of corners", 3, kAnyCount);
    V3f first, before;
    for (int i = 0; i < count && !words.failed(); ++i) {
        const V3f corner(words.vector("a corner"));
        words.skip_numbers(more_numbers, "a normal");
        if (i == 0) first = corner;
        if (i >= 2) add_triangle(words, first, before, corner);
        before = corner;
    }
}

void AffParser::textured_triangle_with(AffWords& words, int more_numbers) {
    words.word("a texture's name");
    V3f corners[3];
    for (V3f& corner : corners) {
        corner = V3f(words.vector("a corner"));
        words.skip_numbers(more_numbers, "a normal or place on the texture");
    }
    add_triangle(words, corners[0], corners[1], corners[2]);
}

void AffParser::moving_triangle(AffWords& words) {
    const int count = words.integer("a count of times", 1, kAnyCount);
    AffMovingTriangle moving{contents_.corners.size() / 3, open_.back().transform, {}, {}};
    for (int i = 0; i < count && !words.failed(); ++i) {
        const double time = words.number("a time");
        if (i > 0 && time < moving.times.back())
            words.fail("the time of a key is before that of the key before");
        moving.times.push_back(time);
        for (int corner = 0; corner < 3; ++corner) {
            moving.corners.emplace_back(words.vector("a corner"));
            words.skip_numbers(3, "a normal");
        }
    }
    if (words.failed()) return;
    add_triangle(words, moving.corners[0], moving.corners[1], moving.corners[2]);
    if (count > 1) contents_.moving.push_back(std::move(moving));
}

void AffParser::mesh(AffWords& words) {
    std::vector<V3f> vertices;
    words.expect("vertices");
    const int vertex_count = words.integer("a count of vertices", 0, kAnyCount);
    for (int i = 0; i < vertex_count && !words.failed(); ++i) vertices.emplace_back(words.vector("a vertex"));
    int more_indices = 0;
    if (words.peek() == "normals") {
        words.expect("normals");
        const int count = words.integer("a count of normals", 0, kAnyCount);
        for (int i = 0; i < count && !words.failed(); ++i) words.skip_numbers(3, "a normal");
        more_indices += 3;
    }
    if (words.peek() == "texturecoords") {
        words.expect("texturecoords");
        const int count = words.integer("a count of places on the texture", 0, kAnyCount);
        words.word("a texture's name");
        for (int i = 0; i < count && !words.failed(); ++i) words.skip_numbers(2, "a place on the texture");
        more_indices += 3;
    }
    words.expect("triangles");
    const int count = words.integer("a count of triangles", 0, kAnyCount);
    if (vertices.empty() && count > 0) words.fail("triangles of a mesh without vertices");
    for (int i = 0; i < count && !words.failed(); ++i) {
        V3f corners[3];
        for (V3f& corner : corners) {
            const int index = words.integer("a vertex", 0, static_cast<int>(vertices.size()) - 1);
            corner = vertices[static_cast<size_t>(index)];
        }
        words.skip_numbers(more_indices, "a normal or place on the texture");
        add_triangle(words, corners[0], corners[1], corners[2]);
    }
}

void AffParser::sphere(AffWords& words) {
    const V3d center = words.vector("a centre");
    const double radius = words.number("a radius");
    add_triangles(words, sphere_triangles(center, std::abs(radius)));  // below 0: seen from within
}

void AffParser::cone(AffWords& words) {
    const V3d base = words.vector("a centre");
    const double base_radius = words.number("a radius");
    const V3d apex = words.vector("a centre");
    const double apex_radius = words.number("a radius");
    if (!((apex - base).length() > 0)) words.fail("both ends of a cone are at the same place");
    if (words.failed()) return;
    add_triangles(words, cone_triangles(base, std::abs(base_radius), apex, std::abs(apex_radius)));
}

void AffParser::light(AffWords& words) {
    words.skip_numbers(3, "a place");
    const std::string_view next = words.peek();
    const bool has_color = !next.empty() && std::string_view("0123456789+-.").find(next[0]) != next.npos;
    if (has_color) color(words);
}

}  // namespace

bool read_aff(const std::string& path, AffContents* contents, std::string* problem) {
    problem->clear();
    AffParser(contents, problem).read_root(path);
    return problem->empty();
}

}  // namespace trapeze
