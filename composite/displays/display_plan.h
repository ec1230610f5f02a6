/// What a Display asks for, decided: file format, channels, pixel type.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/diagnostics.h"
#include "core/scene/aov.h"
#include "core/scene/scene.h"

namespace trapeze {

enum class FileFormat { OpenExr, Tiff, Png, Jpeg, Targa, Bmp };

/// RISpec 4.1.2, Quantize: round(one * value + dither * random in [-1, 1)) clamped to [min, max], one = 0:
/// floats. A Display's own "quantize" says besides where 0 goes.
struct Quantization {
    float one = 255, min = 0, max = 255, dither = 0.5f;
    float zero = 0;

    bool to_float() const { return one == zero; }
    bool has_16_bits() const { return !to_float() && max > 255; }
    void make_float() { one = zero = 0; }
};

struct DisplayPlan {
    std::string path;
    FileFormat format = FileFormat::OpenExr;
    bool depth_map = false;  ///< a depth picture for shadows, by the drivers that are for them
    bool rgb = true, alpha = true, depth = false, id = false;
    /// An output variable, alone in its file: none of the above. Colours are named R G B and a float Y, as
    /// in any picture of one; points, vectors and normals of a variable N are N.X N.Y N.Z, as a Z alone would
    /// be a depth.
    std::optional<Aov> aov;
    bool aov_is_color = false;
    bool float_pixels = false;  ///< OpenEXR: colours in floats, not halves; other variables always are
    std::string compression;    ///< as the format's library calls it; empty: its default
    Quantization quantization;  ///< of the other formats, as they can hold it
    std::vector<Parameter> attributes;  ///< of an OpenEXR header: "exrheader_NAME" without the prefix
    bool srgb = false;                  ///< colours of whole numbers are encoded by the sRGB curve
};

/// Whether its driver writes depths for shadow maps: "zfile" and "shadow".
bool makes_depth_map(const Display& display);

/// Whether depths can be written to a file of this name, which a driver "file" writes as its extension says.
bool holds_depth(const std::string& file);

/// The names of the channels of its output variable.
std::vector<std::string> aov_channel_names(const DisplayPlan& plan);

/// What its driver and its file's extension choose; nothing for driver "null".
std::optional<FileFormat> file_format(const Display& display);

/// Gives its file another name, written as the extension says. What it asks of a format that the file no
/// longer has, a compression and attributes, it asks no more.
void rename(Display& display, std::string name);

/// Whether it asks for a file of whole numbers, by its format or by Quantize.
bool asks_for_whole_numbers(const Display& display, const Options& options);

/// Nothing when there is nothing to write: driver "null", a window beside a file of the same name or picture,
/// or a mode or driver that is not supported, of which it warns. `layout` is aov_layout(options).
std::optional<DisplayPlan> plan_display(const Display& display, const Options& options,
                                        const AovLayout& layout, Diagnostics& diagnostics);

}  // namespace trapeze
