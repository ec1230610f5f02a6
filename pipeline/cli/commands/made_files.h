/// The files that an input will have made by the time that it looks for them: for `check`, which makes none.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace trapeze {

class MadeFiles {
  public:
    /// Adds a picture or map that an earlier world or request would have made.
    void add(const std::string& path);
    /// Whether a map or picture of this name is one of the added files. It is looked for as maps are: by its
    /// own name and by other_names(), there and in the folders.
    bool has(std::string_view name, const std::vector<std::string>& folders) const;

  private:
    std::set<std::string> paths_;
};

}  // namespace trapeze
