#include "composite/displays/cryptomatte_header.h"

#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "composite/mattes/murmur_hash.h"

namespace trapeze {
namespace {

void add_layer(const PictureToWrite& picture, MatteLayer layer, Imf::Header& header) {
    const std::string name(matte_layer_name(layer));
    // The specification: the first seven digits of the name's hash.
    const std::string prefix = "cryptomatte/" + fmt::format("{:08x}", murmur_hash_3(name)).substr(0, 7) + '/';
    const auto add = [&](const char* what, const std::string& value) {
        header.insert((prefix + what).c_str(), Imf::StringAttribute(value));
    };
    add("name", name);
    add("hash", "MurmurHash3_32");
    add("conversion", "uint32_to_float32");
    add("manifest", matte_manifest(*picture.context.scene, layer, *picture.context.diagnostics));
}

}  // namespace

std::string matte_manifest(const Scene& scene, MatteLayer layer, const Diagnostics& sources) {
    nlohmann::json manifest = nlohmann::json::object();
    for (const auto& [name, hash] : matte_names(scene, layer, sources))
        manifest[name] = fmt::format("{:08x}", hash);
    constexpr bool kOnlyAscii = false;
    return manifest.dump(-1, ' ', kOnlyAscii, nlohmann::json::error_handler_t::replace);
}

void add_matte_attributes(const PictureToWrite& picture, Imf::Header& header) {
    bool any = false;
    const auto add = [&](const DisplayPlan& plan) {
        if (!plan.matte) return;
        add_layer(picture, *plan.matte, header);
        any = true;
    };
    add(picture.plan);
    for (const DisplayPlan& plan : picture.further) add(plan);
    if (!any) return;
    const PixelFilter filter = matte_filter(picture.context.scene->options.filter);
    header.insert("cryptomatteFilter", Imf::StringAttribute(fmt::format("{} {:g} {:g}", filter.name,
                                                                        filter.width_x, filter.width_y)));
}

}  // namespace trapeze
