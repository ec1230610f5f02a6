#include "pipeline/compare/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/compare/value_text.h"

namespace trapeze {
namespace {

/// Times closer than this, or than the spread of their rounds, are called equal.
constexpr double kEqualTimes = 1.03;
/// Misses per hit that differ by less do not explain a difference of times.
constexpr double kMoreMisses = 1.5;
/// A build that takes more of the sampling time than this is a reason of its own.
constexpr double kLargeBuild = 0.35;
constexpr float kBlurredPixels = 2;  ///< blur that rasterizers' boxes notice

/// Embree's tests are its own affair.
bool counts_tests(const MethodResult& r) {
    return r.sample.predicate_tests > 0;
}

/// Other samples than those of the rest: it is no contest.
bool is_adaptive(const MethodResult& r) {
    return r.variance > 0;
}

/// Tests without a hit for each hit: what a method's culls let through.
double misses_per_hit(const MethodResult& r) {
    return std::max(0.0, r.tests_per_hit() - 1);
}

std::string time_of(const MethodResult& r) {
    return seconds_text(r.total_median());
}

std::string with_time(const MethodResult& r) {
    return r.method + " (" + time_of(r) + ")";
}

/// Whether the rounds' totals of two methods cannot be told apart.
bool equal_times(const MethodResult& fast, const MethodResult& slow) {
    if (slow.total_median() <= kEqualTimes * fast.total_median()) return true;
    return slow.total_spread().least <= fast.total_spread().most;
}

/// The part by which numbers of hits may differ: on the same samples methods see the same, or, with other
/// code than ours, nearly so.
constexpr double kEqualHits = 0.01;

/// The method that a method disagrees with: the baseline, or the first, of its pattern at its rate. Null when
/// they see about the same.
const MethodResult* opponent_of(const Comparison& c, const MethodResult& r) {
    const MethodResult* judge = nullptr;
    for (const ComparedMethod* m : c.at(r.rate)) {
        if (m->result.pattern != r.pattern || is_adaptive(m->result)) continue;
        if (!judge || m->result.method == c.baseline) judge = &m->result;
    }
    const auto wanted = static_cast<double>(judge->hits), found = static_cast<double>(r.hits);
    return std::abs(found - wanted) > kEqualHits * std::max(found, wanted) ? judge : nullptr;
}

/// Methods whose figures cannot be held against the others': they solved another problem.
std::string disagreement_sentences(const Comparison& c) {
    std::string text;
    for (const ComparedMethod& m : c.methods)
        if (const MethodResult* opponent = is_adaptive(m.result) ? nullptr : opponent_of(c, m.result))
            text += fmt::format(
                "{}At {} samples {} finds {} hits where {} finds {} with the same samples; it takes no part "
                "in "
                "what follows.",
                text.empty() ? "" : " ", rate_text(m.result.rate), m.result.method, m.result.hits,
                opponent->method, opponent->hits);
    return text;
}

/// Whether a method takes part in the contest: references do not, nor methods that find other hits than the
/// rest on the same samples.
bool takes_part(const Comparison& c, const MethodResult& r) {
    return kind_of(r) != MethodKind::Reference && !is_adaptive(r) && !opponent_of(c, r);
}

/// The contest at one sample rate; null where a kind is not there.
struct Standing {
    const MethodResult* fastest = nullptr;
    const MethodResult* tracer = nullptr;      ///< fastest ray tracer
    const MethodResult* rasterizer = nullptr;  ///< fastest rasterizer
};

/// The fastest method, ray tracer and rasterizer at a sample rate, by their median totals.
Standing standing_at(const Comparison& c, SampleRate rate) {
    Standing s;
    const auto take = [](const MethodResult*& best, const MethodResult& r) {
        if (!best || r.total_median() < best->total_median()) best = &r;
    };
    for (const ComparedMethod* m : c.at(rate)) {
        const MethodResult& r = m->result;
        if (!takes_part(c, r)) continue;
        take(s.fastest, r);
        take(kind_of(r) == MethodKind::RayTracer ? s.tracer : s.rasterizer, r);
    }
    return s;
}

std::string blur_sentence(const Comparison& c) {
    const auto& [motion, defocus] = c.blur;
    std::string text = fmt::format("The frame has {} micropolygons. ",
                                   count_text(static_cast<double>(c.frame.tessellate.micropolygons)));
    const auto size = [](const char* what, const BlurSize& blur) {
        return fmt::format("{} up to {} pixels (median {})", what, number_text(blur.largest),
                           number_text(blur.median));
    };
    const std::string circles = size("circles of confusion are", defocus);
    const std::string ways =
        size(defocus.largest > 0 ? "ways while the shutter is open" : "points move", motion);
    if (defocus.largest > 0 && motion.largest > 0) return text + "Its " + circles + ", " + ways + ".";
    if (defocus.largest > 0) return text + "Its " + circles + "; nothing moves.";
    if (motion.largest > 0) return text + "Its " + ways + "; everything is in focus.";
    return text + "Nothing moves and everything is in focus.";
}

/// Why the ray tracer was faster, as far as counts tell; empty where they do not.
std::string why_tracer_wins(const Comparison& c, const MethodResult& tracer, const MethodResult& raster) {
    if (!counts_tests(tracer) || !counts_tests(raster)) return {};
    const double traced = misses_per_hit(tracer), rastered = misses_per_hit(raster);
    if (rastered <= kMoreMisses * traced)
        return fmt::format(
            "Misses do not explain it ({} against {} for each hit): what is done besides the tests does.",
            number_text(rastered), number_text(traced));
    const float blur = std::max(c.blur.defocus.largest, c.blur.motion.largest);
    return fmt::format(
        "For each hit, {} tests {} micropolygons that miss, {} {}{}.", raster.method, number_text(rastered),
        tracer.method, number_text(traced),
        blur >= kBlurredPixels ? ": what is blurred may be met at many samples and covers few of them" : "");
}

/// Why the rasterizer was faster, as far as times and counts tell; empty where they do not.
std::string why_rasterizer_wins(const MethodResult& tracer, const MethodResult& raster) {
    const double share = tracer.total_median() > 0 ? tracer.build_median() / tracer.total_median() : 0;
    if (share > kLargeBuild)
        return fmt::format("Building takes {:.0f}% of the time of {}; {} samples a pixel do not repay it.",
                           share * 100, tracer.method, tracer.rate.per_pixel());
    if (!counts_tests(tracer) || !counts_tests(raster)) return {};
    const double traced = misses_per_hit(tracer), rastered = misses_per_hit(raster);
    const char* form = rastered <= kMoreMisses * traced
                           ? "Its tests seldom miss: {} times for each hit, those of {} {} times."
                           : "It does so although it misses more often ({} times for each hit, {} {} times): "
                             "its tests cost less.";
    return fmt::format(fmt::runtime(form), number_text(rastered), tracer.method, number_text(traced));
}

std::string rate_sentence(const Comparison& c, SampleRate rate) {
    const Standing s = standing_at(c, rate);
    if (!s.fastest) return {};
    const std::string at = "At " + rate_text(rate) + " samples a pixel ";
    if (!s.tracer || !s.rasterizer) return at + with_time(*s.fastest) + " is the fastest.";
    const bool tracer_wins = s.fastest == s.tracer;
    const MethodResult& other = tracer_wins ? *s.rasterizer : *s.tracer;
    if (equal_times(*s.fastest, other))
        return at + with_time(*s.fastest) + " and " + with_time(other) +
               " cannot be told apart by their times.";
    const std::string why = tracer_wins ? why_tracer_wins(c, *s.tracer, *s.rasterizer)
                                        : why_rasterizer_wins(*s.tracer, *s.rasterizer);
    return fmt::format("{}{} is the fastest, {} times as fast as {}, the fastest {}.{}{}", at,
                       with_time(*s.fastest), number_text(other.total_median() / s.fastest->total_median()),
                       with_time(other), tracer_wins ? "rasterizer" : "ray tracer", why.empty() ? "" : " ",
                       why);
}

/// How times grow from the fewest to the most samples.
std::string growth_sentence(const Comparison& c) {
    const auto [low, high] = std::minmax_element(
        c.rates.begin(), c.rates.end(),
        [](const SampleRate& a, const SampleRate& b) { return a.per_pixel() < b.per_pixel(); });
    if (low == c.rates.end() || low->per_pixel() == high->per_pixel()) return {};
    std::string text =
        fmt::format("From {} to {} samples, {} times as many, the times grow ", rate_text(*low),
                    rate_text(*high), number_text(static_cast<double>(high->per_pixel()) / low->per_pixel()));
    const auto few = c.at(*low), many = c.at(*high);
    for (size_t i = 0; i < few.size() && i < many.size(); ++i)
        text += fmt::format("{}{} times for {}",
                            i == 0                ? ""
                            : i + 1 == few.size() ? " and "
                                                  : ", ",
                            number_text(many[i]->result.total_median() / few[i]->result.total_median()),
                            few[i]->result.method);
    return text + ".";
}

/// Which method has the least and the largest error at the most samples. They differ since sample patterns
/// do.
std::string error_sentence(const Comparison& c) {
    if (c.rates.empty()) return {};
    auto methods = c.at(c.rates.back());
    std::erase_if(methods, [&](const ComparedMethod* m) {
        return is_adaptive(m->result) || opponent_of(c, m->result) != nullptr;
    });
    if (methods.size() < 2) return {};
    const auto by_error = [](const ComparedMethod* a, const ComparedMethod* b) { return a->rmse < b->rmse; };
    const auto [least, most] = std::minmax_element(methods.begin(), methods.end(), by_error);
    std::string text = "At " + rate_text(c.rates.back()) + " samples ";
    if ((*most)->rmse <= 1.05 * (*least)->rmse) return text + "the errors of all differ by less than 5%.";
    return text +
           fmt::format("the error is least with {} (RMSE {}, pattern {}) and largest with {} ({}, {}).",
                       (*least)->result.method, number_text((*least)->rmse), (*least)->result.pattern,
                       (*most)->result.method, number_text((*most)->rmse), (*most)->result.pattern);
}

/// What adaptive sampling takes of the time of the same method's whole pattern, and for which error.
std::string adaptive_sentence(const Comparison& c, SampleRate rate) {
    const auto methods = c.at(rate);
    const auto adaptive = std::ranges::find_if(methods, is_adaptive, &ComparedMethod::result);
    if (adaptive == methods.end()) return {};
    const auto whole = std::ranges::find_if(methods, [&](const ComparedMethod* m) {
        return !is_adaptive(m->result) && m->result.sampler.name() == (*adaptive)->result.sampler.name();
    });
    const MethodResult &some = (*adaptive)->result, &all = (*whole)->result;
    return fmt::format(
        "Of {} samples a pixel {} takes {} in the mean for the variance {}, and {} of the time of {}; its RMSE "
        "is {} instead of {}.",
        rate.per_pixel(), some.method, number_text(some.samples_per_pixel()),
        number_text(static_cast<double>(some.variance)),
        number_text(some.total_median() / all.total_median()), all.method, number_text((*adaptive)->rmse),
        number_text((*whole)->rmse));
}

/// The fastest method, or the baseline where its time cannot be told apart from that.
const MethodResult* choice_at(const Comparison& c, SampleRate rate) {
    const MethodResult* fastest = standing_at(c, rate).fastest;
    for (const ComparedMethod* m : c.at(rate))
        if (m->result.method == c.baseline && takes_part(c, m->result) && equal_times(*fastest, m->result))
            return &m->result;
    return fastest;
}

/// The choices by rate, neighbours of one choice together.
std::string conclusion(const Comparison& c) {
    std::vector<SampleRate> rates = c.rates;
    std::stable_sort(rates.begin(), rates.end(),
                     [](const SampleRate& a, const SampleRate& b) { return a.per_pixel() < b.per_pixel(); });
    std::vector<std::pair<std::string, SampleRate>> choices;  // and the first rate at which they are made
    for (const SampleRate& rate : rates) {
        const MethodResult* choice = choice_at(c, rate);
        if (choice && (choices.empty() || choices.back().first != choice->method))
            choices.emplace_back(choice->method, rate);
    }
    if (choices.empty()) return "Nothing was compared that one would render with.";
    std::string text = "For this scene take " + choices.front().first;
    if (choices.size() == 1) return text + (rates.size() == 1 ? "." : " at every sample rate.");
    text += " at " + rate_text(choices.front().second);
    for (size_t i = 1; i < choices.size(); ++i)
        text += fmt::format(", {} from {} on", choices[i].first, rate_text(choices[i].second));
    return text + ".";
}

}  // namespace

std::vector<std::string> judge_without_times(const Comparison& comparison) {
    std::vector<std::string> sentences{blur_sentence(comparison), disagreement_sentences(comparison),
                                       error_sentence(comparison)};
    std::erase_if(sentences, [](const std::string& sentence) { return sentence.empty(); });
    return sentences;
}

std::vector<std::string> judge(const Comparison& comparison) {
    std::vector<std::string> sentences{blur_sentence(comparison), disagreement_sentences(comparison)};
    for (const SampleRate& rate : comparison.rates) sentences.push_back(rate_sentence(comparison, rate));
    sentences.push_back(growth_sentence(comparison));
    sentences.push_back(error_sentence(comparison));
    for (const SampleRate& rate : comparison.rates) sentences.push_back(adaptive_sentence(comparison, rate));
    sentences.push_back(conclusion(comparison));
    std::erase_if(sentences, [](const std::string& sentence) { return sentence.empty(); });
    return sentences;
}

}  // namespace trapeze
