#include "shade/maps/textures.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/files/picture_files.h"
#include "shade/maps/headers/map_header.h"
#include "shade/maps/map_lanes.h"
#include "shade/maps/texture_files.h"
#include "shade/maps/textures_impl.h"
#include "shade/operations/op_table.h"

namespace trapeze {
namespace {

constexpr float kDefaultMemoryMegabytes = 256, kMostConfinedMegabytes = 1024;

float option(const Options& options, const char* category, const char* name, float fallback) {
    return options.user.float_or(category, name, fallback);
}

float memory_megabytes_of(const Options& options) {
    const float kilobytes = option(options, "limits", "texturememory", 0);
    return kilobytes > 0 ? kilobytes / 1024 : kDefaultMemoryMegabytes;
}

/// Whether a name asks for traced rays instead of a map, as shaders of RenderMan do.
bool is_traced(std::string_view name) {
    return name == rsl::kTracedMap;
}

}  // namespace

Textures::Textures(const Options& options, Diagnostics* diagnostics, const Access& access,
                   std::shared_ptr<const ColorManagement> colors)
    : impl_(std::make_unique<Impl>(access)) {
    impl_->memory_megabytes = memory_megabytes_of(options);
    if (access.is_confined())
        impl_->memory_megabytes = std::min(impl_->memory_megabytes, kMostConfinedMegabytes);
    impl_->shadow_bias = option(options, "shadow", "bias", option(options, "shadow", "bias0", -1));
    if (const auto paths = options.search_paths.find("texture"); paths != options.search_paths.end())
        impl_->folders = paths->second;
    impl_->transfer = transfer_of(options);
    impl_->colors = std::move(colors);
    impl_->diagnostics = diagnostics;
}

Textures::~Textures() = default;

std::string Textures::Impl::start() {
    if (cache) return {};
    std::string problem;
    if (const MapLibrary* const library = map_library(&problem))
        cache = library->make_cache(memory_megabytes);
    return problem;
}

/// Opens a picture's file. Returns what is wrong, or nothing.
std::string Textures::Impl::open(Picture& picture) {
    if (is_traced(picture.name)) return "rays are not traced";
    auto file = map_file(picture.name, folders, access);
    if (!file && (file = source_of_texture(picture.name, folders, access)) && diagnostics)
        diagnostics->warning(picture.location,
                             fmt::format("texture \"{}\" is not found; \"{}\" is used", picture.name, *file));
    if (!file) return access.is_closed(picture.name) ? Access::kClosed : "is not found";
    // Rarer formats are read by large libraries: those of films, for one, may open further files.
    if (access.is_confined() && !is_common_picture(*file))
        return "is of a format that is not open to scenes (--safe)";
    std::string problem = start();
    if (!problem.empty()) return problem;
    picture.file = *file;
    picture.map = cache->open(*file, &problem);
    if (problem.empty()) access.note_read(*file);
    return problem;
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

/// The entry of a picture decoded from sRGB. The picture is open already, as it is.
Textures::Impl::Entry<Textures::Picture>& Textures::Impl::decoded_entry(const Picture& picture) {
    const auto known = decoded.find(picture.name);
    if (known != decoded.end()) return known->second;
    Entry<Picture>& made = decoded[picture.name];
    auto opened = cache->open_decoded(*picture.map, picture.file, &made.problem);
    if (made.problem.empty())
        made.map = std::make_unique<Picture>(
            Picture{std::move(opened), picture.file, picture.name, picture.location});
    return made;
}

const Textures::Picture* Textures::Impl::converted_picture(const Picture& picture, const std::string& space,
                                                           SourceLocation location) {
    const auto [known, is_new] = transforms.try_emplace(space);
    auto& [transform, problem] = known->second;
    if (is_new) transform = colors->from_space(space, &problem);
    if (!transform && problem.empty()) return &picture;
    const auto [place, is_first] = converted.try_emplace({space, picture.name});
    Entry<Picture>& made = place->second;
    if (is_first) {
        if (!problem.empty()) made.problem = fmt::format("colour space \"{}\": {}", space, problem);
        auto opened =
            transform ? cache->open_converted(*picture.map, picture.file, space, *transform, &made.problem)
                      : nullptr;
        if (opened)
            made.map = std::make_unique<Picture>(
                Picture{std::move(opened), picture.file, picture.name, picture.location});
    }
    return report(made, picture.name, location);
}

/// The colour space that the config's rules give a file; empty: none.
const std::string& Textures::Impl::space_by_rules(const std::string& file) {
    const auto [known, is_new] = spaces_by_rules.try_emplace(file);
    if (is_new) known->second = colors->space_of_file(file);
    return known->second;
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

const Textures::Picture* Textures::find(std::string_view name, SourceLocation location,
                                        const TextureReading& reading) {
    if (name.empty()) return nullptr;
    const std::lock_guard lock(impl_->mutex);
    const Picture* picture = impl_->report(impl_->entry(name, location), name, location);
    if (!picture) return nullptr;
    const MapFacts& facts = picture->map->facts;
    std::string space = reading.space;
    if (reading.follows_rules && facts.has_colors) space = impl_->space_by_rules(picture->file);
    if (!space.empty()) return impl_->converted_picture(*picture, space, location);
    const bool is_encoded = (reading.transfer == Transfer::Srgb && facts.srgb_if_asked) ||
                            (reading.transfer == Transfer::Auto && facts.srgb_by_itself);
    return is_encoded ? impl_->report(impl_->decoded_entry(*picture), name, location) : picture;
}

TextureReading Textures::reading_of_lookup(std::string_view colorspace, bool of_color,
                                           SourceLocation location) const {
    TextureReading reading(impl_->transfer);
    const auto named = transfer_named(colorspace);
    if (named) reading.transfer = *named;
    reading.follows_rules = impl_->colors && colorspace.empty() && of_color;
    // "linear" and "auto" are no spaces of any config here; "srgb" is the curve where the config has none.
    if (impl_->colors && !colorspace.empty() && named.value_or(Transfer::Srgb) == Transfer::Srgb)
        reading.space = impl_->colors->space_named(colorspace);
    if (!named && reading.space.empty() && !colorspace.empty() && impl_->diagnostics)
        impl_->diagnostics->warning(
            location,
            fmt::format(
                "\"colorspace\" \"{}\" is not known, there are {}; the texture is read as the scene's "
                "Option \"color\" \"transfer\" says",
                colorspace,
                impl_->colors ? fmt::format("{}, and {}", impl_->colors->spaces_listed(), kTransferNames)
                              : kTransferNames),
            fmt::format("colorspace {}", colorspace));
    if (reading.transfer == Transfer::Auto && !of_color) reading.transfer = Transfer::Linear;
    return reading;
}

std::string Textures::Impl::open(DepthMap& map) {
    Entry<Picture>& known = entry(map.name, map.location);
    if (!known.map) {
        known.reported = true;
        return known.problem;
    }
    map.map = known.map->map.get();
    const MapFacts& facts = map.map->facts;
    if (!facts.matrices) return "is no shadow map: it has no matrices worldtocamera and worldtoscreen";
    if (!facts.is_one_float) return "is no shadow map: depths are one channel of floats";
    DepthView& view = map.view;
    view.camera_from_world = facts.matrices->camera_from_world;
    view.screen_from_world = facts.matrices->screen_from_world;
    view.x0 = facts.x0, view.y0 = facts.y0;
    view.x1 = facts.x1, view.y1 = facts.y1;
    view.full_width = static_cast<float>(std::max(facts.full_width, 1));
    view.full_height = static_cast<float>(std::max(facts.full_height, 1));
    const M44f& s = view.screen_from_world;
    view.perspective = s[0][3] != 0 || s[1][3] != 0 || s[2][3] != 0;
    return {};
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

void Textures::check(std::string_view name, SourceLocation location, bool is_depths) {
    const Access& access = impl_->access;
    const auto file = is_traced(name) ? std::nullopt : map_file(std::string(name), impl_->folders, access);
    if (file && (!access.is_confined() || is_common_picture(*file)))
        if (const auto header = plain_map_header(*file);
            header && (!is_depths || (header->is_one_float && header->has_matrices))) {
            access.note_read(*file);
            return;
        }
    if (is_depths)
        find_shadow(name, location);
    else
        find(name, location);
}

std::optional<Textures::Info> Textures::info(std::string_view name) {
    if (name.empty()) return {};
    const std::lock_guard lock(impl_->mutex);
    const Impl::Entry<Picture>& known = impl_->entry(name, {});
    if (!known.map) return {};
    const MapFacts& facts = known.map->map->facts;
    Info info;
    info.width = facts.full_width, info.height = facts.full_height, info.channels = facts.channels;
    info.type = facts.texture_format.find("Environment") != std::string::npos ? "environment"
                : facts.texture_format == "Shadow"                            ? "shadow"
                                                                              : "texture";
    info.wrap_modes = facts.wrap_modes;
    if (facts.matrices) {
        info.viewing_matrix = facts.matrices->camera_from_world;
        info.projection_matrix = facts.matrices->screen_from_world;
    }
    return info;
}

void Textures::texture(const Picture* picture, const TextureLookup& at, const MapOptions& options,
                       Lanes lanes, std::span<const Plane> out) const {
    if (picture)
        impl_->cache->texture(*picture->map, at, options, lanes, out, impl_->reporter(*picture));
    else
        for (const Plane& plane : out) map_lanes::set_all(lanes, plane, options.without);
}

void Textures::environment(const Picture* picture, const EnvironmentLookup& at, const MapOptions& options,
                           Lanes lanes, std::span<const Plane> out) const {
    if (picture)
        impl_->cache->environment(*picture->map, at, options, lanes, out, impl_->reporter(*picture));
    else
        for (const Plane& plane : out) map_lanes::set_all(lanes, plane, options.without);
}

void Textures::shadow(const DepthMap* map, const ShadowLookup& at, const M44f& camera_from_world,
                      const MapOptions& options, Lanes lanes, Plane out) const {
    if (map)
        impl_->cache->shadow({*map->map, map->view, impl_->shadow_bias}, at, camera_from_world, options,
                             lanes, out, impl_->reporter(*map));
    else
        map_lanes::set_all(lanes, out, 0);
}

void Textures::lookup(const Picture& picture, const TextureLookup& at, size_t vertices, Plane3 out) const {
    const Plane planes[] = {out.x, out.y, out.z};
    texture(&picture, at, {}, {vertices, {}}, planes);
}

}  // namespace trapeze
