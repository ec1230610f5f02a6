#include "composite/displays/deep_exr_output.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfPartType.h>

#include <algorithm>
#include <stdexcept>

#include "composite/displays/exr_header.h"
#include "composite/displays/exr_stream.h"
#include "core/half.h"

namespace trapeze {
namespace {

constexpr int kDeepRowsAtOnce = 16;  ///< between looks at whether the render is cancelled

/// A channel of a deep picture: a number of DeepSample.
struct DeepChannel {
    const char* name;
    bool is_half;
    float (*value)(const DeepSample& sample);
};

std::vector<DeepChannel> channels_of(const DisplayPlan& plan) {
    const bool halves = !plan.float_pixels;
    std::vector<DeepChannel> channels;
    if (plan.rgb)
        channels = {{"R", halves, [](const DeepSample& s) { return s.rgba[0]; }},
                    {"G", halves, [](const DeepSample& s) { return s.rgba[1]; }},
                    {"B", halves, [](const DeepSample& s) { return s.rgba[2]; }}};
    channels.push_back({"A", halves, [](const DeepSample& s) { return s.rgba[3]; }});
    channels.push_back({"Z", false, [](const DeepSample& s) { return s.depth; }});
    return channels;
}

/// Some rows as OpenEXR takes them: how many samples each pixel has, and for each channel where they are.
class DeepRows {
  public:
    DeepRows(const Image& image, const std::vector<DeepChannel>& channels)
        : image_(image),
          channels_(channels),
          halves_(channels.size()),
          floats_(channels.size()),
          places_(channels.size()) {}

    Imf::DeepFrameBuffer rows(int y0, int y1) {
        const PixelRect& window = image_.window;
        const size_t first = image_.index(window.x0, y0), end = image_.index(window.x0, y1);
        counts_.clear();
        for (size_t i = first; i < end; ++i) counts_.push_back(static_cast<unsigned>(image_.deep[i].size()));
        const auto width = static_cast<size_t>(window.width());
        Imf::DeepFrameBuffer buffer;
        buffer.insertSampleCountSlice(Imf::Slice::Make(Imf::UINT, counts_.data(), V2i(window.x0, y0),
                                                       window.width(), y1 - y0, sizeof(unsigned),
                                                       sizeof(unsigned) * width));
        for (size_t c = 0; c < channels_.size(); ++c) {
            const bool is_half = channels_[c].is_half;
            if (is_half)
                place(c, first, end, halves_[c]);
            else
                place(c, first, end, floats_[c]);
            constexpr size_t kPlace = sizeof(char*);
            const std::ptrdiff_t origin =
                static_cast<std::ptrdiff_t>(width) * y0 + window.x0;  // OpenEXR counts from pixel (0, 0)
            char* const base =
                reinterpret_cast<char*>(places_[c].data()) - origin * static_cast<std::ptrdiff_t>(kPlace);
            buffer.insert(channels_[c].name,
                          Imf::DeepSlice(is_half ? Imf::HALF : Imf::FLOAT, base, kPlace, kPlace * width,
                                         is_half ? sizeof(Imath::half) : sizeof(float)));
        }
        return buffer;
    }

  private:
    template <class Value>
    void place(size_t channel, size_t first, size_t end, std::vector<Value>& values) {
        values.clear();
        for (size_t i = first; i < end; ++i)
            for (const DeepSample& sample : image_.deep[i]) {
                const float value = channels_[channel].value(sample);
                if constexpr (std::is_same_v<Value, float>)
                    values.push_back(value);
                else
                    values.push_back(to_half(value));
            }
        places_[channel].clear();
        Value* next = values.data();
        for (const unsigned count : counts_) {
            places_[channel].push_back(next);
            next += count;
        }
    }

    const Image& image_;
    const std::vector<DeepChannel>& channels_;
    std::vector<unsigned> counts_;
    std::vector<std::vector<Imath::half>> halves_;
    std::vector<std::vector<float>> floats_;
    std::vector<std::vector<void*>> places_;
};

void write_deep_pixels(const PictureToWrite& picture, OutputFile& file) {
    const std::vector<DeepChannel> channels = channels_of(picture.plan);
    Imf::Header header = make_exr_header(picture, Imf::ZIPS_COMPRESSION);
    header.setType(Imf::DEEPSCANLINE);
    for (const DeepChannel& channel : channels)
        header.channels().insert(channel.name, Imf::Channel(channel.is_half ? Imf::HALF : Imf::FLOAT));
    ExrStream stream(file, picture.plan.path);
    Imf::DeepScanLineOutputFile out(stream, header);
    DeepRows rows(picture.image, channels);
    const PixelRect& window = picture.image.window;
    for (int y = window.y0; y < window.y1; y += kDeepRowsAtOnce) {
        if (picture.context.is_cancelled()) throw std::runtime_error("cancelled");
        const int y1 = std::min(y + kDeepRowsAtOnce, window.y1);
        out.setFrameBuffer(rows.rows(y, y1));
        out.writePixels(y1 - y);
    }
}

}  // namespace

std::string write_deep_exr(const PictureToWrite& picture, OutputFile& file) {
    if (picture.image.deep.empty()) return "no deep samples were recorded";
    return write_whole(file, [&] { write_deep_pixels(picture, file); });
}

}  // namespace trapeze
