#include "pipeline/compare/write_pictures.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "composite/displays/write_displays.h"

namespace trapeze {
namespace {

/// Writes images of a frame, one after another, in floats.
class PictureWriter {
  public:
    PictureWriter(const SharedFrame& frame, const std::string& folder, const std::string& software,
                  const std::function<void(const std::string&)>& on_file)
        : folder_(folder), on_file_(on_file), info_{software, {}}, context_(frame.context) {
        info_.access = &access_;
        scene_.options = frame.scene->options;
        scene_.camera_from_world = frame.scene->camera_from_world;
        context_.scene = &scene_;
    }
    PictureWriter(const PictureWriter&) = delete;
    PictureWriter& operator=(const PictureWriter&) = delete;

    void write(const Image& image, const std::string& name, const std::string& mode) {
        Display display;
        display.name = (std::filesystem::path(folder_) / (name + ".exr")).string();
        display.type = "openexr", display.mode = mode;
        display.parameters.set({"type", {StorageClass::Uniform, ValueType::String, 1}, {}, {"float"}});
        scene_.options.displays = {display};
        access_.allow_writing(display.name);
        std::vector<WrittenFile> written;
        good_ = write_displays(image, context_, info_, &written) && good_;
        for (const WrittenFile& file : written) on_file_(file.path);
    }
    /// A map as a grey picture; nothing if the method did not fill it.
    void write(const Image& like, const std::vector<float>& map, const std::string& name) {
        if (std::all_of(map.begin(), map.end(), [](float value) { return value == 0; })) return;
        Image image;
        image.width = like.width, image.height = like.height, image.window = like.window;
        for (const float value : map) image.rgba.insert(image.rgba.end(), {value, value, value, 1});
        write(image, name, "rgb");
    }
    bool good() const { return good_; }

  private:
    std::string folder_;
    const std::function<void(const std::string&)>& on_file_;
    Access access_;
    OutputInfo info_;
    Scene scene_;
    RenderContext context_;
    bool good_ = true;
};

}  // namespace

std::string file_name_of(const std::string& method) {
    std::string name = method;
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.') c = '-';
    return name;
}

bool write_pictures(const Comparison& comparison, const SharedFrame& frame, const std::string& folder,
                    const std::string& software, const std::function<void(const std::string&)>& on_file) {
    PictureWriter writer(frame, folder, software, on_file);
    const SampleRate reference{comparison.reference_side, comparison.reference_side};
    writer.write(comparison.reference, "reference_" + rate_text(reference), "rgba");
    for (const ComparedMethod& method : comparison.methods) {
        const std::string name = file_name_of(method.result.method) + "_" + rate_text(method.result.rate);
        const Image& image = method.picture.image;
        writer.write(image, name, "rgba");
        writer.write(image, method.picture.heat.tests, name + "_tests");
        writer.write(image, method.picture.heat.nodes, name + "_nodes");
        if (method.result.variance > 0) writer.write(image, method.picture.heat.samples, name + "_samples");
    }
    return writer.good();
}

}  // namespace trapeze
