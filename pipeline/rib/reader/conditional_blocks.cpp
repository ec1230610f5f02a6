#include "pipeline/rib/reader/conditional_blocks.h"

#include <algorithm>
#include <cstdlib>

namespace trapeze::rib {
namespace {

/// Against files that only open conditions.
constexpr size_t kDeepestConditional = 1000;

/// ElseIf, Else and IfEnd belong to the block of this name; skipped blocks have their own.
constexpr const char* kIf = "IfBegin";

/// The requests that begin and end it.
struct SkippedBlock {
    std::string_view begin, end;
};
/// Changes for a renderer that keeps the scene between pictures.
constexpr SkippedBlock kSkippedBlocks[] = {
    {"EditBegin", "EditEnd"}, {"EditAttributeBegin", "EditAttributeEnd"}, {"EditWorldBegin", "EditWorldEnd"}};

/// A text by its first string, else all the numbers; null is a variable that nobody set.
ConditionValue value_of(const Parameter* parameter) {
    if (!parameter) return {};
    if (!parameter->strings.empty()) return {{}, parameter->strings[0]};
    return {{parameter->floats.begin(), parameter->floats.end()}, {}};
}

/// Attributes that have requests of their own, by the names of those; others are the user's. Numbers of the
/// state itself, and not texts of the file: what a request set, the program's defaults, and later changes
/// look alike.
ConditionValue attribute_value(const Attributes& a, const std::string& name) {
    if (name == "Color") return {{a.color.x, a.color.y, a.color.z}, {}};
    if (name == "Opacity") return {{a.opacity.x, a.opacity.y, a.opacity.z}, {}};
    if (name == "ShadingRate") return {{a.shading_rate}, {}};
    if (name == "Matte") return {{static_cast<double>(a.matte)}, {}};
    if (name == "Sides") return {{static_cast<double>(a.sides)}, {}};
    if (name == "Surface" && a.surface) return {{}, a.surface->name};
    return value_of(a.user.find(name));
}

/// Options likewise; Frame is the number of FrameBegin.
ConditionValue option_value(const Options& o, const std::string& name) {
    if (name == "Frame") return {{static_cast<double>(o.frame)}, {}};
    if (name == "Format")
        return {{static_cast<double>(o.width), static_cast<double>(o.height), o.pixel_aspect}, {}};
    if (name == "PixelSamples") return {{o.samples_x, o.samples_y}, {}};
    if (name == "Shutter") return {{o.shutter_open, o.shutter_close}, {}};
    if (name == "Clipping") return {{o.near_clip, o.far_clip}, {}};
    if (name == "Hider") return {{}, o.hider};
    return value_of(o.user.find(name));
}

}  // namespace

bool ConditionalBlocks::is_conditional(std::string_view request) {
    constexpr std::string_view kRequests[] = {kIf, "ElseIf", "Else", "IfEnd"};
    return std::find(std::begin(kRequests), std::end(kRequests), request) != std::end(kRequests) ||
           std::any_of(std::begin(kSkippedBlocks), std::end(kSkippedBlocks), [&](const SkippedBlock& block) {
               return block.begin == request || block.end == request;
           });
}

/// An attribute comes before an option of the same name, and the environment last.
ConditionValue ConditionalBlocks::value_of_variable(const std::string& name) const {
    constexpr std::string_view kAttribute = "Attribute:", kOption = "Option:";
    if (name.starts_with(kAttribute))
        return attribute_value(state_.attributes().attributes, name.substr(kAttribute.size()));
    if (name.starts_with(kOption)) return option_value(state_.options(), name.substr(kOption.size()));
    ConditionValue value = attribute_value(state_.attributes().attributes, name);
    if (value.is_undefined()) value = option_value(state_.options(), name);
    const bool looks_further = value.is_undefined() && access_.may_see_environment();
    const char* const in_environment = looks_further ? std::getenv(name.c_str()) : nullptr;
    if (in_environment) value.text = in_environment;
    return value;
}

/// A condition that cannot be understood holds not: what it guards is left out. A name that nobody knows is a
/// warning by itself: a misspelt variable makes a condition false in silence otherwise.
bool ConditionalBlocks::holds(const std::string& expression) {
    const ConditionResult result =
        evaluate_condition(expression, [this](const std::string& name) { return value_of_variable(name); });
    if (!result.problem.empty()) {
        report_.error("the condition " + in_quotes(expression) + " is wrong: " + result.problem +
                      "; taken as false");
        return false;
    }
    for (const std::string& name : result.undefined)
        report_.warn_once("no option or attribute " + in_quotes(name) + "; it equals nothing",
                          "undefined-" + name);
    return result.holds;
}

/// A block within one that is skipped is skipped too, whatever it says.
void ConditionalBlocks::push(std::string_view name, bool is_active) {
    if (blocks_.size() >= kDeepestConditional)
        throw RequestError{"conditions are nested more than " + std::to_string(kDeepestConditional) + " deep",
                           {}};
    blocks_.push_back({name, report_.at(), is_skipping(), is_active, is_active, false});
}

/// Within what is skipped a condition is not evaluated: it may name what only the skipped part would have
/// set, and a message about it would be of no use.
void ConditionalBlocks::if_begin(const std::string& expression) {
    const bool outer_skips = is_skipping();
    push(kIf, !outer_skips && holds(expression));
}

/// A condition that another stream has opened cannot be closed here.
ConditionalBlocks::OpenCondition& ConditionalBlocks::innermost(std::string_view name) {
    if (blocks_.size() <= first_ || blocks_.back().name != name)
        throw RequestError{"no " + std::string(name) + " is open here", {}};
    return blocks_.back();
}

/// Conditions after the branch that was taken are not evaluated, as they may name what is not there.
void ConditionalBlocks::else_if(const std::string* expression) {
    OpenCondition& block = innermost(kIf);
    if (block.had_else) throw RequestError{"stands after Else", {}};
    block.had_else = !expression;
    const bool may = !block.outer_skips && !block.was_taken;
    block.is_active = may && (!expression || holds(*expression));
    block.was_taken |= block.is_active;
}

void ConditionalBlocks::if_end() {
    innermost(kIf);
    blocks_.pop_back();
}

/// These blocks nest like conditions that never hold. The message comes once for a block that is skipped, and
/// not for those within.
void ConditionalBlocks::skip_block() {
    for (const SkippedBlock& block : kSkippedBlocks) {
        if (report_.name() == block.begin) {
            if (!is_skipping()) {
                report_.count_unsupported();
                report_.warn_once("is not supported; skipped up to " + std::string(block.end),
                                  "unsupported-" + report_.name());
            }
            push(block.begin, false);
        } else if (report_.name() == block.end) {
            innermost(block.begin);
            blocks_.pop_back();
        }
    }
}

/// Conditions of outer streams stay on the stack, where is_skipping() sees them, but are out of reach of the
/// Else and IfEnd of the inner one.
size_t ConditionalBlocks::begin_stream() {
    return std::exchange(first_, blocks_.size());
}

/// A stream that was broken off (cancelled, or ErrorHandler "abort") has open conditions for that reason, so
/// nothing is said of them.
void ConditionalBlocks::end_stream(size_t outer, bool is_whole) {
    for (; blocks_.size() > first_; blocks_.pop_back()) {
        if (!is_whole) continue;
        const OpenCondition& block = blocks_.back();
        report_.set_request(report_.at(), block.name);
        report_.error(block.at, "never closed; closed at the end of the stream");
    }
    first_ = outer;
}

/// Conditions are left alone: their own grammar has variables, which tell numbers from texts. Run before each
/// request, so the usual file, without such an option, costs one look at an empty map.
void ConditionalBlocks::substitute(RequestText& request) const {
    if (state_.options().user.empty() || is_conditional(request.name)) return;
    for (const char* category : {"ribparse", "rib"}) {
        const std::string marker = state_.options().user.string_or(category, "varsubst", "");
        if (marker.empty()) continue;
        for (Argument& argument : request.arguments)
            for (std::string& text : argument.strings)
                if (text.find(marker) != std::string::npos)
                    text = substitute_variables(
                        text, marker, [this](const std::string& name) { return value_of_variable(name); });
    }
}

}  // namespace trapeze::rib
