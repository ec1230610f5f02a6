#include "composite/displays/cryptomatte_header.h"

#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

#include "composite/mattes/murmur_hash.h"

namespace trapeze {
namespace {

/// A text as JSON has it. Bytes that are no ASCII stay: names are UTF-8.
std::string json_string(const std::string& text) {
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            quoted += fmt::format("\\{}", c);
        else if (static_cast<unsigned char>(c) < 32)
            quoted += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
        else
            quoted += c;
    }
    return quoted + '"';
}

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
    std::string manifest = "{";
    for (const auto& [name, hash] : matte_names(scene, layer, sources))
        manifest += fmt::format("{}{}:\"{:08x}\"", manifest.size() > 1 ? "," : "", json_string(name), hash);
    return manifest + '}';
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
