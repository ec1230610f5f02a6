#include "shade/textures.h"

#include <OpenImageIO/imagecache.h>
#include <OpenImageIO/texture.h>
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <mutex>

#include "shade/linear_image_input.h"

namespace trapeze {
namespace {

constexpr float kDefaultMemoryMegabytes = 256;

struct DestroyCache {
    void operator()(OIIO::ImageCache* cache) const { OIIO::ImageCache::destroy(cache); }
};
struct DestroySystem {
    void operator()(OIIO::TextureSystem* system) const { OIIO::TextureSystem::destroy(system); }
};

float memory_megabytes(const Options& options) {
    const auto limits = options.user.find("limits");
    const float kilobytes = limits == options.user.end() ? 0 : limits->second.float_or("texturememory", 0);
    return kilobytes > 0 ? kilobytes / 1024 : kDefaultMemoryMegabytes;
}

std::string resolved_path(const std::string& name, const std::vector<std::string>& folders) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    if (fs::path(name).is_relative())
        for (const std::string& folder : folders) {
            const fs::path path = fs::path(folder) / name;
            if (fs::is_regular_file(path, ignored)) return path.string();
        }
    return name;
}

float finite(float value) {
    return std::isfinite(value) ? value : 0;
}

}  // namespace

class Textures::Picture {
  public:
    OIIO::TextureSystem::TextureHandle* handle = nullptr;
    OIIO::TextureOpt options;
    std::string name;
    SourceLocation location;
};

struct Textures::Impl {
    std::unique_ptr<OIIO::ImageCache, DestroyCache> cache;
    std::unique_ptr<OIIO::TextureSystem, DestroySystem> system;
    std::vector<std::string> folders;
    float memory_megabytes = kDefaultMemoryMegabytes;
    Diagnostics* diagnostics = nullptr;
    std::mutex mutex;
    std::map<std::string, std::unique_ptr<Picture>, std::less<>> pictures;  ///< null: cannot be read

    /// Not get_perthread_info(): what that leaves behind in a thread outlives the cache and then touches it.
    std::mutex idle_mutex;
    std::vector<OIIO::TextureSystem::Perthread*> idle;  ///< threads' states that nobody uses now

    ~Impl() {
        for (OIIO::TextureSystem::Perthread* state : idle) system->destroy_thread_info(state);
    }
    OIIO::TextureSystem::Perthread* take_thread_state() {
        const std::lock_guard lock(idle_mutex);
        if (idle.empty()) return system->create_thread_info();
        OIIO::TextureSystem::Perthread* state = idle.back();
        idle.pop_back();
        return state;
    }
    void give_back(OIIO::TextureSystem::Perthread* state) {
        const std::lock_guard lock(idle_mutex);
        idle.push_back(state);
    }

    /// Makes the cache, which a render without textures goes without.
    void start();
    std::unique_ptr<Picture> open(const std::string& name, SourceLocation location);
};

Textures::Textures(const Options& options, Diagnostics* diagnostics) : impl_(std::make_unique<Impl>()) {
    impl_->memory_megabytes = memory_megabytes(options);
    if (const auto paths = options.search_paths.find("texture"); paths != options.search_paths.end())
        impl_->folders = paths->second;
    impl_->diagnostics = diagnostics;
}

Textures::~Textures() = default;

void Textures::Impl::start() {
    if (system) return;
    cache.reset(OIIO::ImageCache::create(false));
    cache->attribute("max_memory_MB", memory_megabytes);
    cache->attribute("autotile", 64);
    cache->attribute("automip", 1);
    system.reset(OIIO::TextureSystem::create(false, cache.get()));
    system->attribute("gray_to_rgb", 1);
}

std::unique_ptr<Textures::Picture> Textures::Impl::open(const std::string& name, SourceLocation location) {
    start();
    const OIIO::ustring path(resolved_path(name, folders));
    cache->add_file(path, &LinearImageInput::create);
    auto picture = std::make_unique<Picture>();
    picture->handle = system->get_texture_handle(path);
    if (!picture->handle || !system->good(picture->handle)) {
        std::string reason = system->geterror();
        if (reason.empty()) reason = cache->geterror();
        if (diagnostics)
            diagnostics->error(location, fmt::format("texture \"{}\": {}; white is used", name,
                                                     reason.empty() ? "cannot be read" : reason));
        return nullptr;
    }
    picture->name = name;
    picture->location = location;
    const char* modes = nullptr;
    OIIO::TextureSystem::Perthread* thread = take_thread_state();
    if (!system->get_texture_info(picture->handle, thread, 0, OIIO::ustring("wrapmodes"),
                                  OIIO::TypeDesc::STRING, &modes)) {
        system->geterror();
        picture->options.swrap = picture->options.twrap = OIIO::TextureOpt::WrapPeriodic;
    }
    give_back(thread);
    return picture;
}

const Textures::Picture* Textures::find(std::string_view name, SourceLocation location) {
    if (name.empty()) return nullptr;
    const std::lock_guard lock(impl_->mutex);
    const auto known = impl_->pictures.find(name);
    if (known != impl_->pictures.end()) return known->second.get();
    const std::string key(name);
    return impl_->pictures.emplace(key, impl_->open(key, location)).first->second.get();
}

void Textures::lookup(const Picture& picture, const Lookup& at, size_t vertices, Plane3 out) const {
    OIIO::TextureSystem& system = *impl_->system;
    OIIO::TextureSystem::Perthread* thread = impl_->take_thread_state();
    OIIO::TextureOpt options = picture.options;
    for (size_t i = 0; i < vertices; ++i) {
        float color[3] = {1, 1, 1};
        const bool good = system.texture(picture.handle, thread, options, finite(at.s[i]), finite(at.t[i]),
                                         finite(at.dsdu[i]), finite(at.dtdu[i]), finite(at.dsdv[i]),
                                         finite(at.dtdv[i]), 3, color);
        if (!good && impl_->diagnostics)
            impl_->diagnostics->error(picture.location,
                                      fmt::format("texture \"{}\": {}", picture.name, system.geterror()),
                                      "texture read " + picture.name);
        for (int k = 0; k < 3; ++k) out[k][i] = good ? color[k] : 1;
    }
    impl_->give_back(thread);
    for (int k = 0; k < 3; ++k) load(out[k], vertices, out[k]);
}

}  // namespace trapeze
