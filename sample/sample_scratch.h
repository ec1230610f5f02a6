/// A thread's working memory while it resolves tiles.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "core/hit_buffer.h"
#include "sample/loose_hits.h"

namespace trapeze {

/// What samples cost, for pictures of it: indexed by sample, set to zero by the caller.
struct SampleHeat {
    std::vector<uint32_t> tests;  ///< predicate tests
    std::vector<uint32_t> nodes;  ///< nodes visited, or (rasterizers) boxes set up that reached the sample
};

/// One object of each type that somebody asked for, made when first asked for. So every method owns its
/// working memory, and who calls methods need not know of it.
class OwnScratch {
  public:
    template <class T>
    T& of() {
        for (const auto& [type, object] : objects_)
            if (type == &kTypeOf<T>) return *static_cast<T*>(object.get());
        objects_.emplace_back(&kTypeOf<T>, std::make_shared<T>());
        return *static_cast<T*>(objects_.back().second.get());
    }

  private:
    template <class T>
    static constexpr char kTypeOf = 0;  ///< its address stands for the type

    std::vector<std::pair<const void*, std::shared_ptr<void>>> objects_;
};

/// One a thread, used again from tile to tile, by whatever methods and for whatever grids. What it holds is
/// what hit_lists.h makes hit buffers from. Lists keep their capacity from tile to tile; nothing in them
/// survives a call of resolve() but what the method itself keeps in `own`.
struct SampleScratch {
    SampleHeat* heat = nullptr;  ///< when set, methods add what each sample cost
    LayerWindow window;          ///< the hits that are wanted; by default all
    std::vector<Hit> nearest;    ///< sample -> nearest opaque hit
    LooseHits found;             ///< in the order of finding
    std::vector<uint32_t> next;  ///< sample -> where in a buffer its next hit goes
    size_t own_list_bytes = 0;   ///< of lists of hits that a method has besides
    OwnScratch own;              ///< of methods
};

}  // namespace trapeze
