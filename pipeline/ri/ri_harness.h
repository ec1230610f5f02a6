/// What calls of the RenderMan Interface write, and what they report, for tests.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <string>
#include <vector>

#include "core/files/file_text_harness.h"
#include "core/files/temporary_folder_harness.h"
#include "pipeline/ri/ri.h"

namespace trapeze::ri {

struct Reported {
    RtInt code, severity;
    std::string text;
};

inline std::vector<Reported>& reported() {
    static std::vector<Reported> all;
    return all;
}

inline void take_report(RtInt code, RtInt severity, char* message) {
    reported().push_back({code, severity, message});
}

/// Long requests go on in further lines, which begin with no letter: here they are one line.
inline std::string unwrapped(const std::string& text) {
    std::string joined;
    for (size_t i = 0; i < text.size(); ++i) {
        const size_t next = text[i] == '\n' ? text.find_first_not_of(" \n", i) : std::string::npos;
        const bool goes_on = next != std::string::npos &&
                             !std::isalpha(static_cast<unsigned char>(text[next])) && text[next] != '#';
        joined += goes_on ? ' ' : text[i];
        if (goes_on) i = next - 1;
    }
    return joined;
}

/// Reports go to reported().
class Ri : public ::testing::Test {
  protected:
    Ri() {
        reported().clear();
        RiLastError = RIE_NOERROR;
        RiErrorHandler(take_report);
    }
    ~Ri() override { RiErrorHandler(RiErrorPrint); }

    std::string path(const std::string& name) const { return folder_.file(name); }
    std::vector<std::string> files() const { return folder_.names(); }

    /// The RIB of some calls, without the lines that begin every file.
    std::string rib_of(const std::function<void()>& calls) {
        const std::string file = path("calls.rib");
        RiBegin(file.c_str());
        calls();
        RiEnd();
        const std::string text = trapeze::testing::file_text(file),
                          head = "##RenderMan RIB-Structure 1.0\nversion 3.03\n";
        EXPECT_TRUE(text.starts_with(head)) << text;
        return unwrapped(text.substr(std::min(head.size(), text.size())));
    }

    std::vector<RtInt> reported_codes() const {
        std::vector<RtInt> codes;
        for (const Reported& one : reported()) codes.push_back(one.code);
        return codes;
    }

  private:
    trapeze::testing::TemporaryFolder folder_;
};

}  // namespace trapeze::ri
