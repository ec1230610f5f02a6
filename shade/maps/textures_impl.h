/// What the files of Textures share; theirs alone.
#pragma once

// First: OpenImageIO's texture.h declares vectors of its own where it has not seen Imath's.
#include "core/math.h"

#include <OpenImageIO/imagecache.h>
#include <OpenImageIO/texture.h>

#include <cmath>
#include <map>
#include <mutex>

#include "shade/maps/textures.h"

namespace trapeze {

class Textures::Picture {
  public:
    OIIO::TextureSystem::TextureHandle* handle = nullptr;
    OIIO::ImageCache::ImageHandle* image = nullptr;  ///< the same, for the cache
    std::string file;
    bool srgb_if_asked = false, srgb_by_itself = false;  ///< is_srgb_encoded() for Srgb and Auto
    OIIO::TextureOpt::Wrap swrap = OIIO::TextureOpt::WrapBlack, twrap = OIIO::TextureOpt::WrapBlack;
    std::string wrap_modes;  ///< as the file records them, or empty
    int channels = 0;
    double s_scale = 1, t_scale = 1;        ///< the picture over what the file has of it
    bool s_folds = false, t_folds = false;  ///< OpenImageIO cannot repeat it: coordinates are folded
    bool y_up = false;                      ///< an environment as OpenEXR has it
    std::string name;
    SourceLocation location;
};

class Textures::DepthMap {
  public:
    OIIO::ImageCache::ImageHandle* handle = nullptr;
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;     ///< the pixels that the file has
    float full_width = 1, full_height = 1;  ///< of the picture they are part of
    M44f camera_from_world, screen_from_world;
    bool perspective = true;
    std::string name;
    SourceLocation location;
};

struct Textures::Impl {
    struct DestroyCache {
        void operator()(OIIO::ImageCache* made) const { OIIO::ImageCache::destroy(made); }
    };
    struct DestroySystem {
        void operator()(OIIO::TextureSystem* made) const { OIIO::TextureSystem::destroy(made); }
    };

    std::unique_ptr<OIIO::ImageCache, DestroyCache> cache;
    std::unique_ptr<OIIO::TextureSystem, DestroySystem> system;
    std::vector<std::string> folders;
    float memory_megabytes = 0;
    float shadow_bias = -1;  ///< below zero: none is set
    Transfer transfer = Transfer::Linear;
    Diagnostics* diagnostics = nullptr;
    const Access& access;

    /// A picture or depth map, or why there is none.
    template <class Map>
    struct Entry {
        std::unique_ptr<Map> map;
        std::string problem;
        bool reported = false;
    };
    std::mutex mutex;
    std::map<std::string, Entry<Picture>, std::less<>> pictures;  ///< numbers as they are
    std::map<std::string, Entry<Picture>, std::less<>> decoded;   ///< the same names, from sRGB
    std::map<std::string, Entry<DepthMap>, std::less<>> depth_maps;

    explicit Impl(const Access& files) : access(files) {}
    ~Impl();

    /// Whole depth maps, for as long as somebody uses them; with a mutex of their own.
    std::mutex depths_mutex;
    std::map<std::string, std::weak_ptr<const std::vector<float>>, std::less<>> depths;
    std::shared_ptr<const std::vector<float>> all_depths(const DepthMap& map, SourceLocation location);

    /// Makes the cache, which a render without textures goes without. The mutex is held.
    void start();
    Entry<Picture>& entry(std::string_view name, SourceLocation location);
    Entry<Picture>& decoded_entry(const Picture& picture);
    std::string open(Picture& picture);
    std::string describe(Picture& picture, const OIIO::ImageSpec& spec);
    void find_folds(Picture& picture, const OIIO::ImageSpec& spec);
    std::string open_file(Picture& picture, const std::string& name, OIIO::ImageInput::Creator creator);
    std::string add_file(OIIO::ustring path, OIIO::ImageInput::Creator creator);
    std::string open(DepthMap& map);
    template <class Map>
    const Map* report(Entry<Map>& entry, std::string_view name, SourceLocation location);
    void report_read_error(const std::string& name, SourceLocation location, std::string error);

    /// Calls look_up(options, thread, lane, channels, color), which returns whether it could read, for each
    /// wanted lane, and stores what it gives. In texture_lookup.cpp.
    template <class LookUp>
    void each_lane(const Picture* picture, const MapOptions& options, const Lanes& lanes,
                   std::span<const Plane> out, LookUp&& look_up);

    /// A thread's state of the cache, for as long as this lives.
    class ThreadState {
      public:
        explicit ThreadState(Impl& impl) : impl_(impl), state_(impl.take_thread_state()) {}
        ~ThreadState() { impl_.give_back(state_); }
        ThreadState(const ThreadState&) = delete;
        ThreadState& operator=(const ThreadState&) = delete;
        OIIO::TextureSystem::Perthread* get() const { return state_; }
        /// A TextureSystem's state is that of its cache.
        OIIO::ImageCache::Perthread* of_cache() const {
            return reinterpret_cast<OIIO::ImageCache::Perthread*>(state_);
        }

      private:
        Impl& impl_;
        OIIO::TextureSystem::Perthread* state_;
    };

    OIIO::TextureSystem::Perthread* take_thread_state();
    void give_back(OIIO::TextureSystem::Perthread* state);

    /// Not get_perthread_info(), and no call that leaves the state out and so asks it: what that leaves
    /// behind in a thread outlives the cache, and a later cache at the same address takes it for its own.
    std::mutex idle_mutex;
    std::vector<OIIO::TextureSystem::Perthread*> idle;  ///< threads' states that nobody uses now
};

namespace map_lanes {

/// A lane of an input, as textures.h says.
inline float value(ConstPlane plane, size_t i) {
    if (plane.empty()) return 0;
    const float v = plane[i < plane.size() ? i : 0];
    return std::isfinite(v) ? v : 0;
}

inline V3f value(const ConstPlane3& planes, size_t i) {
    return {value(planes.x, i), value(planes.y, i), value(planes.z, i)};
}

bool is_on(const Lanes& lanes, size_t i);
/// Gives the lanes past the last one its value.
void pad(const Lanes& lanes, Plane out);

}  // namespace map_lanes

}  // namespace trapeze
