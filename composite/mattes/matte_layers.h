/// Cryptomatte: which names of a scene's primitives pictures tell apart, and which numbers stand for them
/// [Friedman15].
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostics.h"
#include "core/scene/scene.h"

namespace trapeze {

/// What a layer names. Object: Attribute "identifier" "name"; where there is none the place of the request,
/// as "scene.rib:12". Material: the surface shader's name. Asset: the first "identifier" "name" of the
/// outermost block that has one; else the object's.
enum class MatteLayer : uint8_t { Object, Material, Asset };
inline constexpr MatteLayer kMatteLayers[] = {MatteLayer::Object, MatteLayer::Material, MatteLayer::Asset};

/// Ids of a pixel that a layer keeps, those that cover the most of it; and floats of a pixel that hold them,
/// each id before its coverage.
inline constexpr int kMatteRanks = 6, kMatteFloats = 2 * kMatteRanks;

/// "crypto_object" and so on: a Display's mode, and the layer's name in files.
std::string_view matte_layer_name(MatteLayer layer);
std::optional<MatteLayer> matte_layer_named(std::string_view mode);

/// The layers that the Displays of a scene ask for, each once, in the order of kMatteLayers.
std::vector<MatteLayer> matte_layers(const Options& options);

/// The name of a primitive in a layer.
std::string matte_name(const Primitive& primitive, MatteLayer layer, const Diagnostics& sources);

/// The number that stands for a name: its hash as the bits of a float, which is never an infinity, a NaN or
/// denormal.
float matte_id(uint32_t hash);

/// All names of a scene in a layer, with their hashes.
std::map<std::string, uint32_t> matte_names(const Scene& scene, MatteLayer layer, const Diagnostics& sources);

/// The filter of mattes: the picture's where none of its weights is negative, else a box of its width, since
/// no coverage is negative.
PixelFilter matte_filter(const PixelFilter& picture);

/// What the film adds up coverage by: a number for each combination of names that the layers tell apart.
class MatteKeys {
  public:
    /// Of no layers: nothing is asked for.
    MatteKeys() = default;
    MatteKeys(const Scene& scene, std::vector<MatteLayer> layers, const Diagnostics& sources);

    size_t layer_count() const { return layers_.size(); }
    uint32_t key_of(uint32_t primitive) const { return key_of_primitive_[primitive]; }
    float id(uint32_t key, size_t layer) const { return ids_[key * layers_.size() + layer]; }

  private:
    std::vector<MatteLayer> layers_;
    std::vector<uint32_t> key_of_primitive_;
    std::vector<float> ids_;  ///< of each key, in each layer
};

}  // namespace trapeze
