/// Textures of one render, through a TextureSystem of its own with bounded memory. This file's implementation
/// is the only place that knows OpenImageIO.
///
/// s runs across the picture and t down it, from its top row at 0. Pictures of 8-bit numbers are taken to
/// linear light as they are read, by the sRGB curve and before any filtering, unless their metadata says that
/// they are linear already; other formats are taken as they are. Outside 0..1 a picture repeats, unless its
/// own metadata says otherwise.
#pragma once

#include <memory>
#include <string_view>

#include "core/diagnostics.h"
#include "core/scene.h"
#include "shade/planes.h"

namespace trapeze {

class Textures {
  public:
    /// Option "limits" "texturememory" (kilobytes) bounds the memory; searched are the folders of
    /// Option "searchpath" "texture". diagnostics may be null.
    Textures(const Options& options, Diagnostics* diagnostics);
    ~Textures();
    Textures(const Textures&) = delete;
    Textures& operator=(const Textures&) = delete;

    /// An opened picture, of this object; null for an empty name or one that cannot be read, which is
    /// reported once. Thread-safe.
    class Picture;
    const Picture* find(std::string_view name, SourceLocation location);

    /// Texture coordinates and how they change from a vertex to the next along u and v of the grid: what a
    /// lookup is filtered over.
    struct Lookup {
        ConstPlane s, t, dsdu, dtdu, dsdv, dtdv;
    };
    /// The picture's colours; grey ones fill all three channels. Thread-safe.
    void lookup(const Picture& picture, const Lookup& at, size_t vertices, Plane3 out) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace trapeze
