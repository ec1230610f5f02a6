#include "pipeline/ri/parameters.h"

#include <algorithm>
#include <cstdint>

#include "pipeline/ri/call.h"
#include "pipeline/ri/pairs.h"

namespace trapeze::ri {
namespace {

struct UsualValue {
    const char* category;
    const char* name;
    ValueType type;
    int length = 1;
};

/// Values of options, attributes, displays and hiders that programs give without declarations.
constexpr UsualValue kUsual[] = {
    {"rib", "format", ValueType::String},
    {"rib", "compression", ValueType::String},
    {"limits", "bucketsize", ValueType::Integer, 2},
    {"limits", "gridsize", ValueType::Integer},
    {"limits", "texturememory", ValueType::Integer},
    {"limits", "eyesplits", ValueType::Integer},
    {"limits", "othreshold", ValueType::Color},
    {"limits", "zthreshold", ValueType::Color},
    {"statistics", "endofframe", ValueType::Integer},
    {"hidden", "aperture", ValueType::Float, 4},
    {"hidden", "jitter", ValueType::Integer},
    {"hidden", "depthfilter", ValueType::String},
    {"hidden", "samplemotion", ValueType::Integer},
    {"hidden", "maxvpdepth", ValueType::Integer},
    {"identifier", "shadinggroup", ValueType::String},
    {"trimcurve", "sense", ValueType::String},
    {"light", "shadows", ValueType::String},
    {"cull", "backfacing", ValueType::Integer},
    {"cull", "hidden", ValueType::Integer},
    {"dice", "binary", ValueType::Integer},
    {"dice", "rasterorient", ValueType::Integer},
    {"dice", "hair", ValueType::Integer},
    {"dice", "minlength", ValueType::Float},
    {"visibility", "camera", ValueType::Integer},
    {"visibility", "diffuse", ValueType::Integer},
    {"visibility", "specular", ValueType::Integer},
    {"visibility", "transmission", ValueType::Integer},
    {"visibility", "trace", ValueType::Integer},
    {"grouping", "membership", ValueType::String},
    {"shade", "diffusehitmode", ValueType::String},
    {"shade", "specularhitmode", ValueType::String},
    {"shade", "transmissionhitmode", ValueType::String},
    {"trace", "bias", ValueType::Float},
    {"trace", "displacements", ValueType::Integer},
    {"trace", "maxdepth", ValueType::Integer},
    {"trace", "levels", ValueType::Integer},
    {"trace", "maxdiffusedepth", ValueType::Integer},
    {"trace", "maxspeculardepth", ValueType::Integer},
    {"trace", "samplemotion", ValueType::Integer},
    {"light", "nsamples", ValueType::Integer},
    {"light", "samples", ValueType::Integer},
    {"display", "quantize", ValueType::Float, 4},
    {"display", "dither", ValueType::Float},
    {"display", "colorspace", ValueType::String},
    {"color", "transfer", ValueType::String},
    {"ocio", "config", ValueType::String},
    {"ocio", "display", ValueType::String},
    {"ocio", "look", ValueType::String},
    {"ocio", "view", ValueType::String},
    {"ocio", "workingspace", ValueType::String},
    {"map", "colorspace", ValueType::String},
    {"display", "filter", ValueType::String},
    {"display", "filterwidth", ValueType::Float, 2},
    {"display", "exposure", ValueType::Float, 2},
    {"display", "origin", ValueType::Integer, 2},
};

/// The name and declaration of a token: among the usual ones of its category, as RiDeclare has it, or within
/// the token itself.
std::optional<std::pair<std::string, Declaration>> declared(const Context& context, const std::string& token,
                                                            const std::string& category) {
    for (const UsualValue& usual : kUsual)
        if (category == usual.category && token == usual.name)
            return {{token, {StorageClass::Uniform, usual.type, usual.length}}};
    return context.declarations.resolve(token);
}

/// Whether a variable is the points: one for each vertex whatever the program declares them to be, as the
/// reader takes them.
bool is_points(std::string_view name) {
    return name == "P" || name == "Pw" || name == "Pz";
}

bool has_null(const RiParameter& parameter) {
    if (parameter.type != ValueType::String) return false;
    const auto* const strings = static_cast<const RtString*>(parameter.values);
    return std::find(strings, strings + parameter.count, nullptr) != strings + parameter.count;
}

}  // namespace

std::vector<RiParameter> checked_parameters(Context& context, const RiArguments& arguments,
                                            const VariableCounts& counts, const std::string& category) {
    std::vector<RiParameter> list;
    if (arguments.count <= 0) return list;
    if (!arguments.tokens || !arguments.values)
        throw CallError{RIE_MISSINGDATA, "the parameters' tokens or values are null"};
    if (arguments.count >= kMostPairs)
        throw CallError{RIE_LIMIT,
                        std::to_string(kMostPairs) + " parameters or more: RI_NULL may be missing"};
    const auto leave_out = [&](RtInt code, const std::string& text) {
        context.complain(code, RIE_ERROR, text + "; left out");
    };
    for (int i = 0; i < arguments.count; ++i) {
        if (!arguments.tokens[i]) {
            leave_out(RIE_BADTOKEN, "a parameter's token is null");
            continue;
        }
        const std::string token = arguments.tokens[i];
        const auto known = declared(context, token, category);
        if (!known) {
            leave_out(RIE_BADTOKEN, "\"" + token + "\" is not declared");
            continue;
        }
        const auto& [name, declaration] = *known;
        const auto components = declaration.type == ValueType::Color
                                    ? static_cast<size_t>(context.counting.samples_per_color)
                                    : static_cast<size_t>(component_count(declaration.type));
        const int items = is_points(name) ? counts.vertex : counts.of(declaration.storage);
        const RiParameter parameter{
            token, declaration.type, arguments.values[i],
            components * static_cast<size_t>(declaration.array_length) * static_cast<size_t>(items)};
        if (!parameter.values || has_null(parameter))
            leave_out(RIE_MISSINGDATA, "the value of \"" + token + "\" is null");
        else
            list.push_back(parameter);
    }
    return list;
}

void write_parameters(rib::RibWriter& writer, const std::vector<RiParameter>& parameters) {
    for (const RiParameter& parameter : parameters) {
        writer.string(parameter.token);
        switch (parameter.type) {
            case ValueType::String: {
                const auto* const strings = static_cast<const RtString*>(parameter.values);
                writer.strings(std::vector<std::string>(strings, strings + parameter.count));
                break;
            }
            case ValueType::Integer:
                writer.integers({static_cast<const int*>(parameter.values), parameter.count});
                break;
            default:
                writer.numbers({static_cast<const float*>(parameter.values), parameter.count});
        }
    }
}

std::vector<std::string> strings_of(const RtString* values, int64_t count, const char* what) {
    std::vector<std::string> strings;
    for (const RtString value : array_of(values, count, what)) strings.emplace_back(required(value, what));
    return strings;
}

int sum_of(std::span<const int> counts, int least, const char* what) {
    int64_t sum = 0;
    for (const int count : counts) {
        if (count < least)
            throw CallError{RIE_RANGE, std::to_string(count) + " " + what + ", where at least " +
                                           std::to_string(least) + " are needed"};
        sum += count;
    }
    if (sum > INT32_MAX) throw CallError{RIE_LIMIT, std::string("too many ") + what};
    return static_cast<int>(sum);
}

void write_numbers(const char* request, std::initializer_list<float> numbers) {
    call((std::string("Ri") + request).c_str(), [&](Context& context) {
        context.writer().request(request);
        for (const float number : numbers) context.writer().number(number);
    });
}

void write_option(const char* request, std::initializer_list<float> numbers) {
    call((std::string("Ri") + request).c_str(), [&](Context& context) {
        context.expect_options();
        context.writer().request(request);
        for (const float number : numbers) context.writer().number(number);
    });
}

}  // namespace trapeze::ri
