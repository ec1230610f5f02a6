#include "shade/maps/openimageio/map_cache.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <thread>

#include "shade/maps/openimageio/converted_image_input.h"
#include "shade/maps/openimageio/linear_image_input.h"
#include "shade/maps/openimageio/map_matrices.h"

namespace trapeze {

OpenImageIoCache::OpenImageIoCache(float megabytes) : cache_(OIIO::ImageCache::create(false)) {
    cache_->attribute("max_memory_MB", megabytes);
    cache_->attribute("autotile", 64);
    cache_->attribute("automip", 1);
    cache_->attribute("deduplicate", 0);  // a file decoded is not the same as it is
    system_.reset(OIIO::TextureSystem::create(false, cache_.get()));
    system_->attribute("latlong_up", "z");
    // All channels lie together in memory: OpenImageIO ends the program at an environment's poles otherwise.
    system_->attribute("max_tile_channels", std::numeric_limits<int>::max());
}

OpenImageIoCache::~OpenImageIoCache() {
    for (OIIO::TextureSystem::Perthread* state : idle_) system_->destroy_thread_info(state);
}

OIIO::TextureSystem::Perthread* OpenImageIoCache::take_thread_state() {
    const std::lock_guard lock(idle_mutex_);
    if (idle_.empty()) return system_->create_thread_info();
    OIIO::TextureSystem::Perthread* state = idle_.back();
    idle_.pop_back();
    return state;
}

void OpenImageIoCache::give_back(OIIO::TextureSystem::Perthread* state) {
    const std::lock_guard lock(idle_mutex_);
    idle_.push_back(state);
}

/// Adds a file with a reader of ours, which is given the config. In a thread of its own, since add_file()
/// asks get_perthread_info(). Returns what is wrong with the file.
std::string OpenImageIoCache::add_file(OIIO::ustring path, OIIO::ImageInput::Creator creator,
                                       const OIIO::ImageSpec* config) {
    std::string problem;
    std::thread([&] {
        if (!cache_->add_file(path, creator, config)) problem = cache_->geterror();
    }).join();
    return problem;
}

/// Opens the file that the cache knows by `name`. Returns what is wrong, or nothing.
std::string OpenImageIoCache::open_file(CachedMap& map, const std::string& name,
                                        OIIO::ImageInput::Creator creator, const OIIO::ImageSpec* config) {
    const OIIO::ustring path(name);
    const std::string problem = add_file(path, creator, config);
    const ThreadState thread(*this);
    map.handle = system_->get_texture_handle(path, thread.get());
    map.image = cache_->get_image_handle(path, thread.of_cache());
    if (map.handle && map.image && system_->good(map.handle)) return {};
    std::string reason = problem;
    if (reason.empty()) reason = system_->geterror();
    if (reason.empty()) reason = cache_->geterror();
    return reason.empty() ? "cannot be read" : reason;
}

std::unique_ptr<OpenMap> OpenImageIoCache::open(const std::string& file, std::string* problem) {
    auto map = std::make_unique<CachedMap>();
    *problem = open_file(*map, file, nullptr);
    if (problem->empty()) *problem = find_facts(*map);
    return problem->empty() ? std::move(map) : nullptr;
}

std::unique_ptr<OpenMap> OpenImageIoCache::open_decoded(const OpenMap& map, const std::string& file,
                                                        std::string* problem) {
    auto decoded = std::make_unique<CachedMap>(static_cast<const CachedMap&>(map));
    *problem = open_file(*decoded, LinearImageInput::decoded_name(file), &LinearImageInput::create);
    return problem->empty() ? std::move(decoded) : nullptr;
}

std::unique_ptr<OpenMap> OpenImageIoCache::open_converted(const OpenMap& map, const std::string& file,
                                                          const std::string& space,
                                                          const ColorTransform& transform,
                                                          std::string* problem) {
    auto converted = std::make_unique<CachedMap>(static_cast<const CachedMap&>(map));
    const OIIO::ImageSpec config = ConvertedImageInput::config_of(transform, file);
    *problem = open_file(*converted, ConvertedImageInput::converted_name(file, space),
                         &ConvertedImageInput::create, &config);
    return problem->empty() ? std::move(converted) : nullptr;
}

/// Fills map.facts. Returns what makes lookups impossible, or nothing.
std::string OpenImageIoCache::find_facts(CachedMap& map) {
    const ThreadState thread(*this);
    OIIO::ImageSpec in_file, spec;
    if (!cache_->get_imagespec(map.image, thread.of_cache(), in_file, 0, 0, true) ||
        !cache_->get_imagespec(map.image, thread.of_cache(), spec))
        return cache_->geterror();
    map.facts.has_colors = in_file.nchannels - (in_file.alpha_channel >= 0 ? 1 : 0) >= 3;
    map.facts.srgb_if_asked = is_srgb_encoded(in_file, Transfer::Srgb);
    map.facts.srgb_by_itself = is_srgb_encoded(in_file, Transfer::Auto);
    return describe(map, spec);
}

/// Takes from a file's description what lookups need to know. Returns what they cannot work with.
std::string OpenImageIoCache::describe(CachedMap& map, const OIIO::ImageSpec& spec) {
    if (spec.nchannels < 1 || spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.deep)
        return "is no picture of rows and columns";
    MapFacts& facts = map.facts;
    facts.full_width = spec.full_width, facts.full_height = spec.full_height;
    facts.channels = spec.nchannels;
    facts.x0 = spec.x, facts.y0 = spec.y;
    facts.x1 = spec.x + spec.width, facts.y1 = spec.y + spec.height;
    facts.is_one_float = spec.format == OIIO::TypeDesc::FLOAT && spec.nchannels == 1;
    facts.texture_format = spec.get_string_attribute("textureformat");
    facts.matrices = map_matrices(spec);
    map.s_scale = static_cast<double>(std::max(spec.full_width, 1)) / spec.width;
    map.t_scale = static_cast<double>(std::max(spec.full_height, 1)) / spec.height;
    facts.wrap_modes = spec.get_string_attribute("wrapmodes");
    if (!facts.wrap_modes.empty()) {
        OIIO::TextureOpt::parse_wrapmodes(facts.wrap_modes.c_str(), map.swrap, map.twrap);
        for (OIIO::TextureOpt::Wrap* wrap : {&map.swrap, &map.twrap})
            if (*wrap == OIIO::TextureOpt::WrapDefault) *wrap = OIIO::TextureOpt::WrapBlack;
    }
    map.y_up = spec.get_string_attribute("oiio:updirection") == "y";
    find_folds(map, spec);
    return {};
}

/// Finds along which axes coordinates must be folded. OpenImageIO repeats a picture whose width is a power of
/// two by a short cut, for which it takes the whole picture, of every resolution, to be one: it ends the
/// program where a part or a smaller picture is not.
void OpenImageIoCache::find_folds(CachedMap& map, const OIIO::ImageSpec& spec) {
    const auto is_power = [](int size) {
        return std::has_single_bit(static_cast<unsigned>(std::max(size, 0)));
    };
    const ThreadState thread(*this);
    OIIO::ImageSpec level = spec;
    for (int i = 1;; ++i) {
        map.s_folds = map.s_folds || (is_power(spec.width) && !is_power(level.full_width));
        map.t_folds = map.t_folds || (is_power(spec.height) && !is_power(level.full_height));
        if (!cache_->get_imagespec(map.image, thread.of_cache(), level, 0, i)) break;
    }
    cache_->geterror();
}

std::string OpenImageIoCache::read_depths(const OpenMap& map, std::vector<float>& depths) {
    const MapFacts& facts = map.facts;
    depths.resize(static_cast<size_t>(facts.x1 - facts.x0) * static_cast<size_t>(facts.y1 - facts.y0));
    const ThreadState thread(*this);
    const bool good =
        cache_->get_pixels(static_cast<const CachedMap&>(map).image, thread.of_cache(), 0, 0, facts.x0,
                           facts.x1, facts.y0, facts.y1, 0, 1, 0, 1, OIIO::TypeDesc::FLOAT, depths.data());
    if (good) return {};
    const std::string reason = cache_->geterror();
    return reason.empty() ? "cannot be read" : reason;
}

}  // namespace trapeze
