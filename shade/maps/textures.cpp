#include "shade/maps/textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <thread>

#include "core/files/picture_files.h"
#include "shade/maps/linear_image_input.h"
#include "shade/maps/map_matrices.h"
#include "shade/maps/texture_files.h"
#include "shade/maps/textures_impl.h"

namespace trapeze {
namespace {

constexpr float kDefaultMemoryMegabytes = 256, kMostConfinedMegabytes = 1024;

float option(const Options& options, const char* category, const char* name, float fallback) {
    const auto list = options.user.find(category);
    return list == options.user.end() ? fallback : list->second.float_or(name, fallback);
}

float memory_megabytes_of(const Options& options) {
    const float kilobytes = option(options, "limits", "texturememory", 0);
    return kilobytes > 0 ? kilobytes / 1024 : kDefaultMemoryMegabytes;
}

/// The name by which shaders of RenderMan ask for rays instead of a map.
bool is_traced(std::string_view name) {
    return name == "raytrace";
}

}  // namespace

MapOptions::Filter map_filter(std::string_view name) {
    if (name == "box" || name == "triangle" || name == "bilinear") return MapOptions::Filter::Bilinear;
    if (name == "nearest" || name == "closest" || name == "point") return MapOptions::Filter::Nearest;
    return MapOptions::Filter::Smooth;
}

MapOptions::Wrap map_wrap(std::string_view name) {
    if (name == "black") return MapOptions::Wrap::Black;
    if (name == "periodic") return MapOptions::Wrap::Periodic;
    if (name == "clamp") return MapOptions::Wrap::Clamp;
    if (name == "mirror") return MapOptions::Wrap::Mirror;
    return MapOptions::Wrap::OfPicture;
}

void quad_sides(ConstPlane corner_00, ConstPlane corner_10, ConstPlane corner_01, ConstPlane corner_11,
                const QuadSides& sides) {
    for (size_t i = 0; i < sides.middle.size(); ++i) {
        const float a = map_lanes::value(corner_00, i), b = map_lanes::value(corner_10, i);
        const float c = map_lanes::value(corner_01, i), d = map_lanes::value(corner_11, i);
        sides.middle[i] = ((a + b) + (c + d)) * 0.25f;
        sides.along_u[i] = ((b - a) + (d - c)) * 0.5f;
        sides.along_v[i] = ((c - a) + (d - b)) * 0.5f;
    }
}

bool map_lanes::is_on(const Lanes& lanes, size_t i) {
    return lanes.mask.empty() || std::bit_cast<uint32_t>(lanes.mask[i < lanes.mask.size() ? i : 0]) != 0;
}

void map_lanes::pad(const Lanes& lanes, Plane out) {
    if (lanes.count > 0 && lanes.count < out.size())
        std::fill(out.begin() + static_cast<std::ptrdiff_t>(lanes.count), out.end(), out[lanes.count - 1]);
}

Textures::Textures(const Options& options, Diagnostics* diagnostics, const Access& access)
    : impl_(std::make_unique<Impl>(access)) {
    impl_->memory_megabytes = memory_megabytes_of(options);
    if (access.is_confined())
        impl_->memory_megabytes = std::min(impl_->memory_megabytes, kMostConfinedMegabytes);
    impl_->shadow_bias = option(options, "shadow", "bias", option(options, "shadow", "bias0", -1));
    if (const auto paths = options.search_paths.find("texture"); paths != options.search_paths.end())
        impl_->folders = paths->second;
    impl_->transfer = transfer_of(options);
    impl_->diagnostics = diagnostics;
}

Textures::~Textures() = default;

Textures::Impl::~Impl() {
    for (OIIO::TextureSystem::Perthread* state : idle) system->destroy_thread_info(state);
}

OIIO::TextureSystem::Perthread* Textures::Impl::take_thread_state() {
    const std::lock_guard lock(idle_mutex);
    if (idle.empty()) return system->create_thread_info();
    OIIO::TextureSystem::Perthread* state = idle.back();
    idle.pop_back();
    return state;
}

void Textures::Impl::give_back(OIIO::TextureSystem::Perthread* state) {
    const std::lock_guard lock(idle_mutex);
    idle.push_back(state);
}

void Textures::Impl::start() {
    if (system) return;
    cache.reset(OIIO::ImageCache::create(false));
    cache->attribute("max_memory_MB", memory_megabytes);
    cache->attribute("autotile", 64);
    cache->attribute("automip", 1);
    cache->attribute("deduplicate", 0);  // a file decoded is not the same as it is
    system.reset(OIIO::TextureSystem::create(false, cache.get()));
    system->attribute("latlong_up", "z");
    // All channels lie together in memory: it ends the program at an environment's poles where they do not.
    system->attribute("max_tile_channels", std::numeric_limits<int>::max());
}

/// In a thread of its own, since add_file() asks get_perthread_info(). Returns what is wrong with the file.
std::string Textures::Impl::add_file(OIIO::ustring path, OIIO::ImageInput::Creator creator) {
    std::string problem;
    std::thread([&] {
        if (!cache->add_file(path, creator)) problem = cache->geterror();
    }).join();
    return problem;
}

/// By the name that the cache has for it. Empty when it is open, else what is wrong.
std::string Textures::Impl::open_file(Picture& picture, const std::string& name,
                                      OIIO::ImageInput::Creator creator) {
    const OIIO::ustring path(name);
    const std::string problem = add_file(path, creator);
    const ThreadState thread(*this);
    picture.handle = system->get_texture_handle(path, thread.get());
    picture.image = cache->get_image_handle(path, thread.of_cache());
    if (picture.handle && picture.image && system->good(picture.handle)) return {};
    std::string reason = problem;
    if (reason.empty()) reason = system->geterror();
    if (reason.empty()) reason = cache->geterror();
    return reason.empty() ? "cannot be read" : reason;
}

/// Empty when it is open, else what is wrong.
std::string Textures::Impl::open(Picture& picture) {
    if (is_traced(picture.name)) return "rays are not traced";
    auto file = map_file(picture.name, folders, access);
    if (!file && (file = source_of_texture(picture.name, folders, access)) && diagnostics)
        diagnostics->warning(picture.location,
                             fmt::format("texture \"{}\" is not found; \"{}\" is used", picture.name, *file));
    if (!file) return access.is_closed(picture.name) ? Access::kClosed : "is not found";
    // What is behind rarer formats is wide: films, for one, which may name further files.
    if (access.is_confined() && !is_common_picture(*file))
        return "is of a format that is not open to scenes (--safe)";
    start();
    picture.file = *file;
    if (std::string problem = open_file(picture, *file, nullptr); !problem.empty()) return problem;
    const ThreadState thread(*this);
    OIIO::ImageSpec in_file, spec;
    if (!cache->get_imagespec(picture.image, thread.of_cache(), in_file, 0, 0, true) ||
        !cache->get_imagespec(picture.image, thread.of_cache(), spec))
        return cache->geterror();
    picture.srgb_if_asked = is_srgb_encoded(in_file, Transfer::Srgb);
    picture.srgb_by_itself = is_srgb_encoded(in_file, Transfer::Auto);
    return describe(picture, spec);
}

/// Takes what lookups need to know. Returns what they cannot work with.
std::string Textures::Impl::describe(Picture& picture, const OIIO::ImageSpec& spec) {
    if (spec.nchannels < 1 || spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.deep)
        return "is no picture of rows and columns";
    picture.channels = spec.nchannels;
    picture.s_scale = static_cast<double>(std::max(spec.full_width, 1)) / spec.width;
    picture.t_scale = static_cast<double>(std::max(spec.full_height, 1)) / spec.height;
    picture.wrap_modes = spec.get_string_attribute("wrapmodes");
    if (!picture.wrap_modes.empty()) {
        OIIO::TextureOpt::parse_wrapmodes(picture.wrap_modes.c_str(), picture.swrap, picture.twrap);
        for (OIIO::TextureOpt::Wrap* wrap : {&picture.swrap, &picture.twrap})
            if (*wrap == OIIO::TextureOpt::WrapDefault) *wrap = OIIO::TextureOpt::WrapBlack;
    }
    picture.y_up = spec.get_string_attribute("oiio:updirection") == "y";
    find_folds(picture, spec);
    return {};
}

/// OpenImageIO repeats what is a power of two wide by a short cut, for which it takes the whole picture, of
/// every resolution, to be one, too: it ends the program where a part or a smaller picture is not.
void Textures::Impl::find_folds(Picture& picture, const OIIO::ImageSpec& spec) {
    const auto is_power = [](int size) {
        return std::has_single_bit(static_cast<unsigned>(std::max(size, 0)));
    };
    const ThreadState thread(*this);
    OIIO::ImageSpec level = spec;
    for (int i = 1;; ++i) {
        picture.s_folds = picture.s_folds || (is_power(spec.width) && !is_power(level.full_width));
        picture.t_folds = picture.t_folds || (is_power(spec.height) && !is_power(level.full_height));
        if (!cache->get_imagespec(picture.image, thread.of_cache(), level, 0, i)) break;
    }
    cache->geterror();
}

Textures::Impl::Entry<Textures::Picture>& Textures::Impl::entry(std::string_view name,
                                                                SourceLocation location) {
    const auto known = pictures.find(name);
    if (known != pictures.end()) return known->second;
    Entry<Picture>& made = pictures[std::string(name)];
    made.map = std::make_unique<Picture>();
    made.map->name = name, made.map->location = location;
    made.problem = open(*made.map);
    if (!made.problem.empty()) made.map.reset();
    return made;
}

/// Of a picture that is open as it is: the same, decoded from sRGB.
Textures::Impl::Entry<Textures::Picture>& Textures::Impl::decoded_entry(const Picture& picture) {
    const auto known = decoded.find(picture.name);
    if (known != decoded.end()) return known->second;
    Entry<Picture>& made = decoded[picture.name];
    made.map = std::make_unique<Picture>(picture);
    made.problem =
        open_file(*made.map, LinearImageInput::decoded_name(picture.file), &LinearImageInput::create);
    if (!made.problem.empty()) made.map.reset();
    return made;
}

template <class Map>
const Map* Textures::Impl::report(Entry<Map>& made, std::string_view name, SourceLocation location) {
    if (!made.map && !made.reported && diagnostics) {
        std::string text = fmt::format("texture \"{}\": {}", name, made.problem);
        if (is_traced(name))
            diagnostics->warning(location, std::move(text));
        else
            diagnostics->error(location, std::move(text));
    }
    made.reported = true;
    return made.map.get();
}

void Textures::Impl::report_read_error(const std::string& name, SourceLocation location, std::string error) {
    if (diagnostics)
        diagnostics->error(location, fmt::format("texture \"{}\": {}", name, error), "texture read " + name);
}

const Textures::Picture* Textures::find(std::string_view name, SourceLocation location, Transfer transfer) {
    if (name.empty()) return nullptr;
    const std::lock_guard lock(impl_->mutex);
    const Picture* picture = impl_->report(impl_->entry(name, location), name, location);
    const bool is_encoded = picture && ((transfer == Transfer::Srgb && picture->srgb_if_asked) ||
                                        (transfer == Transfer::Auto && picture->srgb_by_itself));
    return is_encoded ? impl_->report(impl_->decoded_entry(*picture), name, location) : picture;
}

Transfer Textures::transfer_of_lookup(std::string_view colorspace, bool of_color,
                                      SourceLocation location) const {
    Transfer transfer = impl_->transfer;
    if (const auto named = transfer_named(colorspace))
        transfer = *named;
    else if (!colorspace.empty() && impl_->diagnostics)
        impl_->diagnostics->warning(
            location,
            fmt::format(
                "\"colorspace\" \"{}\" is not known, there are {}; the texture is read as the scene's "
                "Option \"color\" \"transfer\" says",
                colorspace, kTransferNames),
            fmt::format("colorspace {}", colorspace));
    return transfer == Transfer::Auto && !of_color ? Transfer::Linear : transfer;
}

const Textures::DepthMap* Textures::find_shadow(std::string_view name, SourceLocation location) {
    if (name.empty()) return nullptr;
    const std::lock_guard lock(impl_->mutex);
    auto known = impl_->depth_maps.find(name);
    if (known == impl_->depth_maps.end()) {
        known = impl_->depth_maps.emplace(name, Impl::Entry<DepthMap>()).first;
        Impl::Entry<DepthMap>& made = known->second;
        made.map = std::make_unique<DepthMap>();
        made.map->name = name, made.map->location = location;
        made.problem = impl_->open(*made.map);
        if (!made.problem.empty()) made.map.reset();
    }
    return impl_->report(known->second, name, location);
}

std::optional<Textures::Info> Textures::info(std::string_view name) {
    if (name.empty()) return {};
    const std::lock_guard lock(impl_->mutex);
    const Impl::Entry<Picture>& known = impl_->entry(name, {});
    if (!known.map) return {};
    OIIO::ImageSpec spec;
    const Impl::ThreadState thread(*impl_);
    if (!impl_->cache->get_imagespec(known.map->image, thread.of_cache(), spec)) return {};
    Info info;
    info.width = spec.full_width, info.height = spec.full_height, info.channels = spec.nchannels;
    const std::string format = spec.get_string_attribute("textureformat");
    info.type = format.find("Environment") != std::string::npos ? "environment"
                : format == "Shadow"                            ? "shadow"
                                                                : "texture";
    info.wrap_modes = known.map->wrap_modes;
    if (const auto matrices = map_matrices(spec)) {
        info.viewing_matrix = matrices->camera_from_world;
        info.projection_matrix = matrices->screen_from_world;
    }
    return info;
}

}  // namespace trapeze
