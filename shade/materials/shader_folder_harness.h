/// For tests of shaders that stand in files: a folder of them that goes with its object.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace trapeze::testing {

class ShaderFolder {
  public:
    ShaderFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "trapeze-shaders-XXXXXX").string();
        if (mkdtemp(name.data())) path_ = name;
    }
    ~ShaderFolder() {
        std::error_code ignored;
        if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
    }
    ShaderFolder(const ShaderFolder&) = delete;

    const std::string& path() const { return path_; }
    /// NAME.sl
    void write(const std::string& name, const std::string& source) const {
        std::ofstream(path_ + "/" + name + ".sl") << source;
    }

  private:
    std::string path_;
};

}  // namespace trapeze::testing
