#pragma once

#include <string_view>
#include <vector>

namespace trapeze {

/// A name that run_study() knows, and what it shows.
struct StudyName {
    std::string_view name, about;
};

/// All of them, in the order of the table. Here, since who lists them need not have the studies.
inline std::vector<StudyName> study_names() {
    return {
#define TRAPEZE_STUDY(name, title, about, paper) {#name, about},
#include "pipeline/study/studies.def"
#undef TRAPEZE_STUDY
    };
}

}  // namespace trapeze
