/// Reads RIB that a test holds as text.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "pipeline/rib/read_rib.h"

namespace trapeze::testing {

/// A folder that goes when the test ends.
class Folder {
  public:
    Folder() {
        static int count = 0;
        path_ = std::filesystem::temp_directory_path() /
                ("trapeze_rib_" + std::to_string(getpid()) + "_" + std::to_string(count++));
        std::filesystem::create_directories(path_);
    }
    ~Folder() { std::filesystem::remove_all(path_); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    std::string write(const std::string& name, const std::string& text) const {
        const std::filesystem::path path = path_ / name;
        std::filesystem::create_directories(path.parent_path());
        std::ofstream(path, std::ios::binary) << text;
        return path.string();
    }
    std::string path() const { return path_.string(); }

  private:
    std::filesystem::path path_;
};

struct ReadOutcome {
    std::vector<Scene> worlds;
    std::vector<std::string> messages;  ///< places without the folder
    ReadSummary summary;

    const Scene& scene() const { return worlds.at(0); }
    const Primitive& primitive(size_t i = 0) const { return scene().primitives.at(i); }
    const Attributes& attributes(size_t i = 0) const { return *primitive(i).attributes; }
    size_t count() const { return worlds.empty() ? 0 : scene().primitives.size(); }
};

inline ReadOutcome read_files(const Folder& folder, const std::vector<std::string>& files,
                              const ReadOptions& options = {}) {
    ReadOutcome outcome;
    Diagnostics diagnostics([&](const Diagnostic& diagnostic) {
        std::string message = to_string(diagnostic);
        const std::string prefix = folder.path() + "/";
        for (size_t at; (at = message.find(prefix)) != std::string::npos;) message.erase(at, prefix.size());
        outcome.messages.push_back(message);
    });
    outcome.summary = read_rib(files, options, diagnostics,
                               [&](Scene&& scene) { outcome.worlds.push_back(std::move(scene)); });
    return outcome;
}

inline ReadOutcome read_text(const std::string& text, const ReadOptions& options = {}) {
    const Folder folder;
    return read_files(folder, {folder.write("a.rib", text)}, options);
}

/// Text inside a world, on one line.
inline ReadOutcome read_world(const std::string& text, const ReadOptions& options = {}) {
    return read_text("WorldBegin\n" + text + "\nWorldEnd\n", options);
}

inline const std::string kSphere = "Sphere 1 -1 1 360 ";

}  // namespace trapeze::testing
