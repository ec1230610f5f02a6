/// What a Display asks for, decided: file format, channels, pixel type.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "composite/mattes/matte_layers.h"
#include "core/diagnostics.h"
#include "core/scene/aov.h"
#include "core/scene/scene.h"

namespace trapeze {

enum class FileFormat { OpenExr, Tiff, Png, Jpeg, Targa, Bmp };

/// How numbers become a file's whole numbers (RISpec 4.1.2, Quantize): round(one * value + dither * random in
/// [-1, 1)), clamped to [min, max]; one = 0: floats. A Display's own "quantize" also says what 0 becomes.
struct Quantization {
    float one = 255, min = 0, max = 255, dither = 0.5f;
    float zero = 0;

    bool to_float() const { return one == zero; }
    bool has_16_bits() const { return !to_float() && max > 255; }
    void make_float() { one = zero = 0; }
};

/// What is written to one file, and how.
struct DisplayPlan {
    std::string path;
    FileFormat format = FileFormat::OpenExr;
    bool depth_map = false;  ///< depths for shadow maps, by a driver that is for these
    bool rgb = true, alpha = true, depth = false, id = false;
    std::optional<Aov> aov;  ///< an output variable: none of the above
    bool aov_is_color = false;
    std::string layer;                ///< of the variable, where it is not alone in the file
    std::optional<MatteLayer> matte;  ///< a layer of Cryptomatte, alone in the plan
    bool deep = false;                ///< samples of each pixel by their depths; OpenEXR
    bool float_pixels = false;        ///< OpenEXR: colours in floats, not halves; other variables always are
    std::string compression;          ///< as the format's library calls it; empty: its default
    int tile_side = 0;                ///< OpenEXR: pixels of the tiles that the file lies in; 0: in rows
    Quantization quantization;        ///< of the other formats, as they can hold it
    std::vector<Parameter> attributes;  ///< of an OpenEXR header: "exrheader_NAME" without the prefix
    bool srgb = false;                  ///< colours of whole numbers are encoded by the sRGB curve
    bool viewed = false;                ///< where colours are managed, they are as the view has them instead
};

/// Whether the display's driver writes depths for shadow maps: "zfile" and "shadow".
bool makes_depth_map(const Display& display);

/// Whether a driver "file", which chooses a format by the name's extension, can write depths to a file of
/// this name.
bool holds_depth(const std::string& file);

/// Names of the channels that a display makes of its file. Colour is R G B, alpha A, depth Z and the id of a
/// primitive id, whatever else is in the file. A variable's channels are named R G B and Y, as in any picture
/// of a colour or of one number, where it is alone; as a layer among others in the file, which several
/// displays name, they are foo.R foo.G foo.B and foo.Y. Points, vectors and normals are always foo.X foo.Y
/// foo.Z, since a Z alone would be a depth. An id is id.Y as a layer.
/// A layer of Cryptomatte has crypto_object00.R and so on: ids and coverages by turns.
std::vector<std::string> channel_names(const DisplayPlan& plan, bool is_layer);

/// The format that the display's driver and its file's extension choose; nothing for driver "null".
std::optional<FileFormat> file_format(const Display& display);

/// Gives the display's file another name, written as the extension says. A compression and attributes that
/// the new format does not have are dropped.
void rename(Display& display, std::string name);

/// Whether the display asks for a file of whole numbers, by its format or by Quantize. A window's name is no
/// file's.
bool asks_for_whole_numbers(const Display& display, const Options& options);

/// Whether a display of the picture holds more of its colours than halves do: floats, or whole numbers.
bool holds_more_than_halves(const Options& options);

/// The plan of a display; nothing when there is nothing to write: for driver "null", for a window when
/// another display already writes the picture or a file of that name, and, with a warning, for a mode or
/// driver that is not supported. `layout` is aov_layout(options).
std::optional<DisplayPlan> plan_display(const Display& display, const Options& options,
                                        const AovLayout& layout, Diagnostics& diagnostics);

}  // namespace trapeze
