/// For tests of the analysis: what is said of sources.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "shade/rsl/front_end_harness.h"

namespace trapeze::testing {

inline std::unique_ptr<rsl::TranslationUnit> compiled(const std::string& text, Heard& heard) {
    return rsl::compile_front({"t.sl", text}, {}, heard.diagnostics);
}

/// All that is said of a source.
inline std::string said(const std::string& text) {
    Heard heard;
    const auto unit = compiled(text, heard);
    EXPECT_EQ(unit == nullptr, heard.diagnostics.count(Severity::Error) > 0) << heard.all();
    return heard.all();
}

inline std::string in_surface(const std::string& body) {
    return said("surface t(float Kd = 1; string map = \"\"; varying color tint = 1) {" + body + "}");
}

}  // namespace trapeze::testing
