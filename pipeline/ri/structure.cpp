/// Solids, objects and motion blocks (RISpec 5.7, 5.9, 6), archives (7).
#include <cstdarg>
#include <cstdio>
#include <filesystem>

#include "pipeline/ri/call.h"
#include "pipeline/ri/parameters.h"
#include "pipeline/rib/syntax/comments.h"

namespace trapeze::ri {
namespace {

constexpr RtInt kMostTimes = 1000;  ///< of "...", which has no end of its own

void begin_motion(Context& context, std::span<const float> times) {
    for (size_t i = 1; i < times.size(); ++i)
        if (!(times[i - 1] < times[i])) throw CallError{RIE_BADMOTION, "the times do not rise"};
    if (times.empty()) throw CallError{RIE_BADMOTION, "there are no times"};
    context.open(BlockKind::Motion);
    context.writer().request("MotionBegin");
    context.writer().numbers(times);
}

std::string formatted(const char* format, va_list arguments) {
    va_list again;
    va_copy(again, arguments);
    const int length = std::vsnprintf(nullptr, 0, format, again);
    va_end(again);
    if (length < 0) throw CallError{RIE_CONSISTENCY, "the format cannot be printed"};
    std::string text(static_cast<size_t>(length) + 1, '\0');
    std::vsnprintf(text.data(), text.size(), format, arguments);
    text.pop_back();
    return text;
}

/// Every line of it behind the mark.
std::string commented(const std::string& mark, const std::string& text) {
    std::string lines = mark;
    for (size_t i = 0; i < text.size(); ++i) {
        lines += text[i];
        if (text[i] == '\n' && i + 1 < text.size()) lines += mark;
    }
    if (lines.ends_with('\n')) lines.pop_back();
    return lines;
}

constexpr size_t kMostArchiveBytes = size_t{1} << 30;

/// None, with a complaint, when the archive cannot be read now; reading the RIB will say so again.
std::vector<rib::Comment> comments_of(Context& context, const std::string& name) {
    std::vector<rib::Comment> comments;
    const std::filesystem::path path(name);
    std::vector<std::string> places{name};
    if (path.is_relative())
        for (const std::string& folder : context.archive_folders)
            places.push_back((std::filesystem::path(folder) / path).string());
    std::string first_error;
    for (const std::string& place : places) {
        std::string error;
        const auto keep = [&](rib::Comment comment) { comments.push_back(std::move(comment)); };
        if (rib::for_each_comment(place, kMostArchiveBytes, keep, &error)) return comments;
        if (first_error.empty()) first_error = error;
    }
    context.complain(RIE_NOFILE, RIE_WARNING,
                     "\"" + name + "\" cannot be read yet, and the callback is not called: " + first_error);
    return {};
}

void record(Context& context, const std::string& type, const std::string& text) {
    if (type == "comment")
        context.writer().comment(commented("#", text));
    else if (type == "structure")
        context.writer().comment(commented("##", text));
    else if (type == "verbatim")
        context.writer().verbatim(text);
    else
        throw CallError{RIE_BADTOKEN, "\"" + type + "\" is none of comment, structure, verbatim"};
}

}  // namespace
}  // namespace trapeze::ri

using namespace trapeze::ri;

RtVoid RiSolidBegin(RtToken operation) {
    call("RiSolidBegin", [&](Context& context) {
        const std::string name = required(operation, "the operation");
        if (name != "primitive" && name != "union" && name != "intersection" && name != "difference")
            throw CallError{RIE_BADTOKEN,
                            "\"" + name + "\" is none of primitive, union, intersection, difference"};
        context.open(BlockKind::Solid);
        context.writer().request("SolidBegin");
        context.writer().string(name);
    });
}

RtObjectHandle RiObjectBegin() {
    RtObjectHandle handle = nullptr;
    call("RiObjectBegin", [&](Context& context) {
        context.open(BlockKind::Object);
        context.spaces.begin_object();
        ++context.objects;
        context.writer().request("ObjectBegin");
        context.writer().number(static_cast<double>(context.objects));
        handle = reinterpret_cast<RtObjectHandle>(context.objects);
    });
    return handle;
}

RtVoid RiObjectInstance(RtObjectHandle handle) {
    call("RiObjectInstance", [&](Context& context) {
        const auto number = reinterpret_cast<uintptr_t>(handle);
        if (number < 1 || number > context.objects) throw CallError{RIE_BADHANDLE, "no such object"};
        context.writer().request("ObjectInstance");
        context.writer().number(static_cast<double>(number));
    });
}

RtVoid RiMotionBegin(RtInt n, ...) {
    std::vector<float> times;
    va_list rest;
    va_start(rest, n);
    guarded("RiMotionBegin", [&] {
        if (n > kMostTimes) throw CallError{RIE_LIMIT, "more than " + std::to_string(kMostTimes) + " times"};
        for (int i = 0; i < n; ++i) times.push_back(static_cast<float>(va_arg(rest, double)));
    });
    va_end(rest);
    RiMotionBeginV(static_cast<RtInt>(times.size()), times.data());
}

RtVoid RiMotionBeginV(RtInt n, RtFloat times[]) {
    call("RiMotionBegin", [&](Context& context) { begin_motion(context, array_of(times, n, "times")); });
}

RtVoid RiArchiveRecord(RtToken type, const char* format, ...) {
    va_list rest;
    va_start(rest, format);
    call("RiArchiveRecord", [&](Context& context) {
        const std::string kind = required(type, "the type");
        record(context, kind, formatted(required(format, "the format"), rest));
    });
    va_end(rest);
}

RtVoid RiReadArchiveV(RtToken name, RtArchiveCallback callback, RtInt n, RtToken tokens[],
                      RtPointer values[]) {
    std::vector<trapeze::rib::Comment> comments;
    call("RiReadArchive", [&](Context& context) {
        required(name, "the name");
        const auto parameters = checked_parameters(context, {n, tokens, values});
        context.writer().request("ReadArchive");
        context.writer().string(name);
        write_parameters(context.writer(), parameters);
        if (callback) comments = comments_of(context, name);
    });
    // The callback may call the interface.
    std::string format = "%s";
    for (const trapeze::rib::Comment& comment : comments)
        callback(comment.is_structure ? RI_STRUCTURE : RI_COMMENT, format.data(), comment.text.c_str());
}
