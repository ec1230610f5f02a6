/// A MapCache by OpenImageIO: an ImageCache and a TextureSystem on it.
#pragma once

// First: OpenImageIO's texture.h declares vectors of its own where it has not seen Imath's.
#include "core/math.h"

#include <OpenImageIO/imagecache.h>
#include <OpenImageIO/texture.h>

#include <mutex>

#include "shade/maps/map_library.h"

namespace trapeze {

/// A map as this cache knows it.
struct CachedMap final : OpenMap {
    OIIO::TextureSystem::TextureHandle* handle = nullptr;
    OIIO::ImageCache::ImageHandle* image = nullptr;  ///< the same, for the cache
    OIIO::TextureOpt::Wrap swrap = OIIO::TextureOpt::WrapBlack, twrap = OIIO::TextureOpt::WrapBlack;
    double s_scale = 1, t_scale = 1;        ///< the picture over what the file has of it
    bool s_folds = false, t_folds = false;  ///< OpenImageIO cannot repeat it: coordinates are folded
    bool y_up = false;                      ///< an environment as OpenEXR has it
};

class OpenImageIoCache final : public MapCache {
  public:
    explicit OpenImageIoCache(float megabytes);
    ~OpenImageIoCache() override;

    std::unique_ptr<OpenMap> open(const std::string& file, std::string* problem) override;
    std::unique_ptr<OpenMap> open_decoded(const OpenMap& map, const std::string& file,
                                          std::string* problem) override;
    std::unique_ptr<OpenMap> open_converted(const OpenMap& map, const std::string& file,
                                            const std::string& space, const ColorTransform& transform,
                                            std::string* problem) override;
    void texture(const OpenMap& map, const TextureLookup& at, const MapOptions& options, Lanes lanes,
                 std::span<const Plane> out, const ReadFailed& failed) override;
    void environment(const OpenMap& map, const EnvironmentLookup& at, const MapOptions& options, Lanes lanes,
                     std::span<const Plane> out, const ReadFailed& failed) override;
    void shadow(const ShadowMap& map, const ShadowLookup& at, const M44f& camera_from_world,
                const MapOptions& options, Lanes lanes, Plane out, const ReadFailed& failed) override;
    std::string read_depths(const OpenMap& map, std::vector<float>& depths) override;

  private:
    struct DestroyCache {
        void operator()(OIIO::ImageCache* made) const { OIIO::ImageCache::destroy(made); }
    };
    struct DestroySystem {
        void operator()(OIIO::TextureSystem* made) const { OIIO::TextureSystem::destroy(made); }
    };

    /// A thread's state of the cache, for as long as this lives.
    class ThreadState {
      public:
        explicit ThreadState(OpenImageIoCache& owner) : owner_(owner), state_(owner.take_thread_state()) {}
        ~ThreadState() { owner_.give_back(state_); }
        ThreadState(const ThreadState&) = delete;
        ThreadState& operator=(const ThreadState&) = delete;
        OIIO::TextureSystem::Perthread* get() const { return state_; }
        /// A TextureSystem's state is that of its cache.
        OIIO::ImageCache::Perthread* of_cache() const {
            return reinterpret_cast<OIIO::ImageCache::Perthread*>(state_);
        }

      private:
        OpenImageIoCache& owner_;
        OIIO::TextureSystem::Perthread* state_;
    };
    OIIO::TextureSystem::Perthread* take_thread_state();
    void give_back(OIIO::TextureSystem::Perthread* state);

    std::string add_file(OIIO::ustring path, OIIO::ImageInput::Creator creator,
                         const OIIO::ImageSpec* config);
    std::string open_file(CachedMap& map, const std::string& name, OIIO::ImageInput::Creator creator,
                          const OIIO::ImageSpec* config = nullptr);
    std::string find_facts(CachedMap& map);
    std::string describe(CachedMap& map, const OIIO::ImageSpec& spec);
    void find_folds(CachedMap& map, const OIIO::ImageSpec& spec);

    /// Calls look_up(options, thread, lane, channels, color), which returns whether it could read, for each
    /// wanted lane, and stores what it gives. In texture_lookup.cpp.
    template <class LookUp>
    void each_lane(const CachedMap& map, const MapOptions& options, const Lanes& lanes,
                   std::span<const Plane> out, const ReadFailed& failed, LookUp&& look_up);

    std::unique_ptr<OIIO::ImageCache, DestroyCache> cache_;
    std::unique_ptr<OIIO::TextureSystem, DestroySystem> system_;

    /// Threads' states are made and handed out here, not by get_perthread_info() nor by calls that leave the
    /// state out and so ask it: what that leaves behind in a thread outlives the cache, and a later cache at
    /// the same address takes it for its own.
    std::mutex idle_mutex_;
    std::vector<OIIO::TextureSystem::Perthread*> idle_;  ///< threads' states that nobody uses now
};

}  // namespace trapeze
