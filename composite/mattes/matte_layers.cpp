#include "composite/mattes/matte_layers.h"

#include <algorithm>
#include <bit>
#include <filesystem>

#include "composite/mattes/murmur_hash.h"

namespace trapeze {
namespace {

constexpr std::string_view kNames[] = {"crypto_object", "crypto_material", "crypto_asset"};
constexpr const char* kUnnamed = "unnamed";

/// The place of the request that made a primitive, without folders, which are nobody else's business.
std::string place_name(SourceLocation at, const Diagnostics& sources) {
    const std::string file = std::filesystem::path(sources.source_name(at.source)).filename().string();
    return file.empty() ? kUnnamed : file + ':' + std::to_string(at.line);
}

}  // namespace

std::string_view matte_layer_name(MatteLayer layer) {
    return kNames[static_cast<size_t>(layer)];
}

std::optional<MatteLayer> matte_layer_named(std::string_view mode) {
    for (const MatteLayer layer : kMatteLayers)
        if (mode == matte_layer_name(layer)) return layer;
    return {};
}

std::vector<MatteLayer> matte_layers(const Options& options) {
    std::vector<MatteLayer> layers;
    for (const MatteLayer layer : kMatteLayers)
        if (std::ranges::any_of(options.displays, [&](const Display& display) {
                return !display.has_driver("null") && display.mode == matte_layer_name(layer);
            }))
            layers.push_back(layer);
    return layers;
}

std::string matte_name(const Primitive& primitive, MatteLayer layer, const Diagnostics& sources) {
    const Attributes& attributes = *primitive.attributes;
    if (layer == MatteLayer::Material)
        return attributes.surface ? attributes.surface->name : "defaultsurface";
    const std::string& name = layer == MatteLayer::Asset ? attributes.asset : attributes.name;
    return name.empty() ? place_name(primitive.location, sources) : name;
}

float matte_id(uint32_t hash) {
    const uint32_t exponent = hash >> 23 & 255;
    if (exponent == 0 || exponent == 255) hash ^= 1u << 23;
    return std::bit_cast<float>(hash);
}

std::map<std::string, uint32_t> matte_names(const Scene& scene, MatteLayer layer,
                                            const Diagnostics& sources) {
    std::map<std::string, uint32_t> names;
    for (const Primitive& primitive : scene.primitives) {
        std::string name = matte_name(primitive, layer, sources);
        const uint32_t hash = murmur_hash_3(name);
        names.emplace(std::move(name), hash);
    }
    return names;
}

PixelFilter matte_filter(const PixelFilter& picture) {
    constexpr std::string_view kPositive[] = {"gaussian", "box",  "triangle",
                                              "b-spline", "disk", "blackman-harris"};
    const bool is_positive = std::ranges::find(kPositive, picture.name) != std::end(kPositive);
    return is_positive ? picture : PixelFilter{"box", picture.width_x, picture.width_y};
}

MatteKeys::MatteKeys(const Scene& scene, std::vector<MatteLayer> layers, const Diagnostics& sources)
    : layers_(std::move(layers)) {
    if (layers_.empty()) return;
    std::map<std::vector<uint32_t>, uint32_t> keys;
    std::vector<uint32_t> hashes(layers_.size());
    for (const Primitive& primitive : scene.primitives) {
        for (size_t i = 0; i < layers_.size(); ++i)
            hashes[i] = murmur_hash_3(matte_name(primitive, layers_[i], sources));
        const auto [key, is_new] = keys.emplace(hashes, static_cast<uint32_t>(keys.size()));
        key_of_primitive_.push_back(key->second);
        if (is_new) std::ranges::transform(hashes, std::back_inserter(ids_), matte_id);
    }
}

}  // namespace trapeze
