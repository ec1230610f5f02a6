/// Regions: the picture is split, not the data, until the grids and the tree of each part fit the memory
/// budget (RenderAnts' dynamic scheduling [Zhou09]).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "composite/film/awaited_tiles.h"
#include "core/samples.h"
#include "core/scene/camera.h"
#include "core/scene/vertex_set.h"
#include "sample/build_memory.h"
#include "tessellate/tessellate.h"

namespace trapeze {

/// A rectangle of the picture in raster pixels (aligned to tiles but for the picture's own border), and the
/// subpatches that its samples may see, in order.
struct Region {
    PixelRect pixels;
    std::vector<uint32_t> subpatches;
    size_t estimated_bytes = 0;  ///< of grids and tree
    /// Of each subpatch, the vertices whose colours are wanted; empty: all of all.
    std::vector<VertexSet> wanted{};
};

/// What regions must keep to.
struct RegionLimits {
    size_t bytes = 0;      ///< a region's grids and tree may take this much
    int at_least = 1;      ///< regions to make even when fewer would fit (as far as there are tiles)
    int aov_channels = 0;  ///< that every vertex carries besides its colour
    /// Tiles that are wanted: others and what is seen in them alone are left out; null: all are.
    const AwaitedTiles* awaited = nullptr;
    BuildMemory build{};  ///< of the visibility method
    /// Else the grids are there already, and the method alone counts.
    bool with_grids = true;
};

/// Upper estimate, in bytes, of the memory of a subpatch's grid and its part of the tree, but for what is of
/// all together (BuildMemory::bytes_of_all()).
size_t estimated_bytes(const SubpatchInfo& subpatch, const RegionLimits& limits);

/// Splits `pixels`, or the part of them that is awaited, along tile borders, the longer side first, until
/// every region fits or is a single tile.
std::vector<Region> split_into_regions(const PixelRect& pixels, std::span<const SubpatchInfo> subpatches,
                                       const RegionLimits& limits);

}  // namespace trapeze
