#include "sample/sampler_list.h"

namespace trapeze {

/// The first error ends it: a comparison of some of the methods that were asked for would be taken for one of
/// all.
std::optional<std::vector<Sampler>> parse_samplers(std::string_view text, std::string_view pattern,
                                                   std::string* error) {
    constexpr std::string_view kSeparators = " \t\n;";
    std::vector<Sampler> samplers;
    for (size_t begin = text.find_first_not_of(kSeparators); begin != std::string_view::npos;
         begin = text.find_first_not_of(kSeparators, begin)) {
        const size_t end = std::min(text.find_first_of(kSeparators, begin), text.size());
        const auto sampler = choose_sampler(text.substr(begin, end - begin), pattern, error);
        if (!sampler) return {};
        samplers.push_back(*sampler);
        begin = end;
    }
    if (samplers.empty()) {
        *error = "the list of methods is empty";
        return {};
    }
    return samplers;
}

/// Methods that do not honour the pattern are left out without a word, which is what asking for all that do
/// means.
std::vector<Sampler> default_samplers(std::string_view pattern, bool with_references) {
    std::vector<Sampler> samplers;
    for (const VisibilityMethod& method : visibility_methods()) {
        if (method.kind == MethodKind::Reference && !with_references) continue;
        std::string not_honoured;
        if (const auto sampler = choose_sampler(method.name, pattern, &not_honoured))
            samplers.push_back(*sampler);
    }
    return samplers;
}

}  // namespace trapeze
