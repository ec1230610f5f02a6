/// Runs the built program as a user would, in a folder of its own.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "core/files/file_text_harness.h"

namespace trapeze::testing {

/// A temporary folder that goes away with the test.
class WorkFolder {
  public:
    WorkFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "trapeze-test-XXXXXX").string();
        path_ = mkdtemp(pattern.data());
    }
    ~WorkFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;

    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    const std::filesystem::path& path() const { return path_; }
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(path_ / name) << text;
    }

  private:
    std::filesystem::path path_;
};

struct Outcome {
    int exit_code = -1;
    std::string out, err;
};

/// A variable of the environment, for as long as it lives.
class SetVariable {
  public:
    SetVariable(const char* name, const std::string& value) : name_(name) { setenv(name, value.c_str(), 1); }
    ~SetVariable() { unsetenv(name_); }
    SetVariable(const SetVariable&) = delete;

  private:
    const char* name_;
};

/// Runs `trapeze ARGUMENTS` (shell syntax) with the folder as working directory; the user's settings are
/// those in its folder .config. `before`: words that run it, as `env NAME=VALUE`, or nothing.
inline Outcome run_program(const WorkFolder& folder, const std::string& arguments,
                           const std::string& before = {}) {
    const std::string command = "cd '" + folder.path().string() + "' && export XDG_CONFIG_HOME='" +
                                folder.path().string() + "/.config' && " + before +
                                " '" TRAPEZE_PROGRAM "' </dev/null >.stdout 2>.stderr " + arguments;
    const int status = std::system(("bash -c \"" + command + "\"").c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, file_text(folder / ".stdout"),
            file_text(folder / ".stderr")};
}

}  // namespace trapeze::testing
