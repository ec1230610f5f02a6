/// The files that an input has made by the time that it looks for them.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace trapeze {

class MadeFiles {
  public:
    /// A picture or map that a world or a request before makes, had it been carried out.
    void add(const std::string& path);
    /// Whether a map or picture of this name is one of them, looked for as maps are: by its own name and
    /// by other_names(), there and in the folders.
    bool has(std::string_view name, const std::vector<std::string>& folders) const;

  private:
    std::set<std::string> paths_;
};

}  // namespace trapeze
