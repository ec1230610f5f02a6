#include "pipeline/compare/report/report_pictures.h"

#include <fmt/format.h>

#include <algorithm>

#include "pipeline/compare/report/encoded_text.h"
#include "pipeline/compare/report/screen_pictures.h"
#include "pipeline/compare/report/viridis.h"
#include "pipeline/compare/report/worst_places.h"
#include "pipeline/compare/value_text.h"

namespace trapeze {
namespace {

/// Close-ups: pixels of a side, how many, and how much they are enlarged.
constexpr int kPlaceSide = 96, kPlaces = 3, kMagnification = 4;
/// The most pixels of all whole pictures together; each takes about three bytes of the file.
constexpr double kPixelBudget = 16e6;

/// What whole pictures share.
struct Scales {
    int shrink = 1;
    std::vector<float> differences;  ///< by sample rate
    HeatScale tests, nodes, samples;
    bool some_adaptive = false;
};

/// Scales that all pictures of a report share, so that they can be compared by eye. Pictures are shrunk by
/// the least factor that keeps all of them within kPixelBudget.
Scales scales_of(const Comparison& c) {
    Scales scales;
    const double pixels =
        static_cast<double>(c.reference.z.size()) * (1 + 4.0 * static_cast<double>(c.methods.size()));
    while (pixels / (scales.shrink * scales.shrink) > kPixelBudget) ++scales.shrink;
    for (const SampleRate& rate : c.rates) scales.differences.push_back(difference_scale(c, rate));
    std::vector<const std::vector<float>*> tests, nodes, samples;
    for (const ComparedMethod& method : c.methods) {
        tests.push_back(&method.picture.heat.tests);
        nodes.push_back(&method.picture.heat.nodes);
        samples.push_back(&method.picture.heat.samples);
        scales.some_adaptive |= method.result.variance > 0;
    }
    scales.tests = heat_scale(tests), scales.nodes = heat_scale(nodes), scales.samples = heat_scale(samples);
    return scales;
}

std::string image(const std::string& url, const char* kind, const std::string& description) {
    return fmt::format("<img data-kind=\"{}\" alt=\"{}\" src=\"{}\">\n", kind, escaped(description), url);
}

/// A heat map, or a sentence where the method does not count such costs.
std::string heat_image(const std::vector<float>& map, const PixelRect& window, int shrink,
                       const HeatScale& scale, const char* kind, const std::string& method) {
    if (std::all_of(map.begin(), map.end(), [](float value) { return value == 0; }))
        return fmt::format("<p class=\"none\" data-kind=\"{}\">{} does not count them</p>\n", kind,
                           escaped(method));
    return image(png_url(map, window.width(), window.height(), shrink, scale), kind,
                 std::string(kind) + " of " + method);
}

/// How many samples pixels took, or a sentence where all took the same.
std::string samples_image(const ComparedMethod& m, const Scales& scales) {
    if (m.result.variance > 0)
        return heat_image(m.picture.heat.samples, m.picture.image.window, scales.shrink, scales.samples,
                          "samples", m.result.method);
    return fmt::format("<p class=\"none\" data-kind=\"samples\">{} samples in all pixels</p>\n",
                       m.result.rate.per_pixel());
}

/// A method's picture, its difference to the reference, and its heat maps at one sample rate; a script shows
/// one of them at a time.
std::string method_figure(const ComparedMethod& m, const Comparison& c, const Scales& scales) {
    const auto rate = std::find(c.rates.begin(), c.rates.end(), m.result.rate);
    const float difference = scales.differences[static_cast<size_t>(rate - c.rates.begin())];
    const Image& picture = m.picture.image;
    const std::string& name = m.result.method;
    return fmt::format("<figure data-rate=\"{}\">\n", rate_text(m.result.rate)) +
           image(png_url(shrunk(part_of(picture, picture.window), scales.shrink)), "picture",
                 "picture of " + name) +
           image(png_url(shrunk(difference_of(picture, c.reference, difference), scales.shrink)),
                 "difference", "difference of " + name + " to the reference") +
           heat_image(m.picture.heat.tests, picture.window, scales.shrink, scales.tests, "tests", name) +
           heat_image(m.picture.heat.nodes, picture.window, scales.shrink, scales.nodes, "nodes", name) +
           (scales.some_adaptive ? samples_image(m, scales) : "") +
           fmt::format(
               "<figcaption><strong>{}</strong> at {}<span>RMSE {} &middot; "
               "FLIP {} &middot; {}</span></figcaption>\n</figure>\n",
               escaped(name), rate_text(m.result.rate), number_text(m.rmse), number_text(m.flip),
               seconds_text(m.result.total_median()));
}

std::string button(const char* group, const std::string& value, const std::string& text) {
    return fmt::format("<button data-{}=\"{}\">{}</button>", group, escaped(value), escaped(text));
}

std::string toolbar(const Comparison& c, bool some_adaptive) {
    std::string out = "<div class=\"toolbar\">\n<div class=\"choice\"><span>Samples</span>";
    for (const SampleRate& rate : c.rates) out += button("rate", rate_text(rate), rate_text(rate));
    out += "</div>\n<div class=\"choice\"><span>Show</span>" + button("kind", "picture", "Picture") +
           button("kind", "difference", "Difference") + button("kind", "tests", "Tests") +
           button("kind", "nodes", "Nodes") +
           (some_adaptive ? button("kind", "samples", "Samples a pixel") : "");
    return out + "</div>\n</div>\n";
}

std::string legend(const HeatScale& scale, const char* kind, const char* what) {
    constexpr int kStops = 16;
    std::string stops, ticks;
    for (int i = 0; i <= kStops; ++i) {
        const auto [r, g, b] = viridis(static_cast<float>(i) / kStops);
        stops += fmt::format("{}rgb({} {} {})", i ? ", " : "", r, g, b);
    }
    const auto tick = [&](float value) {
        ticks += fmt::format("<span style=\"left:{:.1f}%\">{:.4g}</span>", scale.place(value) * 100, value);
    };
    for (float decade = 1; decade < 0.6f * scale.top; decade *= 10) tick(decade);
    tick(scale.top);
    return fmt::format(
        "<div class=\"scale\" data-kind=\"{}\"><p>{}, logarithmic, the same scale for all</p>"
        "<div style=\"background:linear-gradient(to right, {})\"></div><div class=\"ticks\">{}</div></div>\n",
        kind, what, stops, ticks);
}

std::string whole_pictures(const Comparison& c, const Scales& scales) {
    std::string out =
        "<section id=\"pictures\">\n<h2>Pictures</h2>\n<p>Linear values encoded by the sRGB curve, "
        "clipped at white. Differences to the reference are absolute and linear, times";
    for (size_t i = 0; i < c.rates.size(); ++i)
        out += fmt::format("{} {} at {} samples", i ? "," : "", scales.differences[i], rate_text(c.rates[i]));
    out += ", then encoded the same way.";
    if (scales.shrink > 1) out += fmt::format(" Shown at 1/{} of their size.", scales.shrink);
    out += " Click one to enlarge it.</p>\n" + toolbar(c, scales.some_adaptive) +
           legend(scales.tests, "tests", "Exact tests per sample") +
           legend(scales.nodes, "nodes", "Nodes visited per sample (rasterizers: boxes met)") +
           (scales.some_adaptive ? legend(scales.samples, "samples", "Samples a pixel") : "") +
           "<div class=\"pictures\">\n";
    const SampleRate reference{c.reference_side, c.reference_side};
    out +=
        "<figure>\n" +
        image(png_url(shrunk(part_of(c.reference, c.reference.window), scales.shrink)), "always",
              "the reference") +
        fmt::format(
            "<figcaption><strong>reference</strong> at {}<span>stratified, ray traced</span></figcaption>\n"
            "</figure>\n",
            rate_text(reference));
    for (const ComparedMethod& method : c.methods) out += method_figure(method, c, scales);
    return out + "</div>\n</section>\n";
}

/// The pictures of all methods at the last sample rate.
std::vector<const Image*> last_pictures(const Comparison& c) {
    std::vector<const Image*> pictures;
    if (c.rates.empty()) return pictures;
    for (const ComparedMethod* method : c.at(c.rates.back())) pictures.push_back(&method->picture.image);
    return pictures;
}

std::string close_ups(const Comparison& c) {
    std::string out = fmt::format(
        "<section id=\"places\">\n<h2>The worst places</h2>\n<p>Where the worst method is farthest from the "
        "reference "
        "at {} samples; every pixel {} times as large.</p>\n",
        c.rates.empty() ? "" : rate_text(c.rates.back()), kMagnification);
    for (const PixelRect& place : worst_places(c.reference, last_pictures(c), kPlaceSide, kPlaces)) {
        out += fmt::format("<h3>x {}\u2013{}, y {}\u2013{}</h3>\n<div class=\"crops\">\n", place.x0, place.x1,
                           place.y0, place.y1);
        out += close_up_figure(part_of(c.reference, place), "reference", kMagnification);
        for (const ComparedMethod& method : c.methods)
            out += close_up_figure(part_of(method.picture.image, place), method.result.method, kMagnification,
                                   " data-rate=\"" + rate_text(method.result.rate) + "\"");
        out += "</div>\n";
    }
    return out + "</section>\n";
}

}  // namespace

std::string close_up_figure(const LinearPicture& picture, const std::string& name, int magnified,
                            const std::string& attributes) {
    return fmt::format(
        "<figure{}>\n<img width=\"{}\" height=\"{}\" alt=\"{}\" "
        "src=\"{}\">\n<figcaption>{}</figcaption>\n</figure>\n",
        attributes, picture.width * magnified, picture.height * magnified, escaped("crop of " + name),
        png_url(picture), escaped(name));
}

std::string report_pictures(const Comparison& comparison) {
    return whole_pictures(comparison, scales_of(comparison)) + close_ups(comparison);
}

}  // namespace trapeze
