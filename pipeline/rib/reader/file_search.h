/// Where the files that scenes name are looked for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/files/access.h"
#include "pipeline/rib/reader/open_files.h"
#include "pipeline/rib/reader/request_report.h"
#include "pipeline/rib/state/graphics_state_stack.h"

namespace trapeze::rib {

/// Looks beside the file that is being read, along Option "searchpath", and where exporters are known to put
/// things; never where `access` does not reach.
class FileSearch {
  public:
    FileSearch(Access& access, RequestReport& report, GraphicsStateStack& state, const OpenFiles& files)
        : access_(access), report_(report), state_(state), files_(files) {}

    /// Whether what is read now is the user's own, and not a scene: folders that it searches are opened to
    /// the scenes that follow.
    void set_trusted(bool is_trusted) { is_trusted_ = is_trusted; }

    /// Option "searchpath" "string `category`" [`path`]: see expand_search_path().
    void set_search_path(const std::string& category, const std::string& path);
    /// All folders for files of a category ("archive", "shader", "texture", "procedural"), best first; an
    /// empty one is the working folder.
    std::vector<std::string> folders(const std::string& category) const;
    /// The path of an archive: beside the file that names it, along the search path, from the working folder.
    /// One that is not there may have been named by another machine, or from its project's folder: it is
    /// looked for without its leading folders, then from the folders above, and a warning says so.
    std::optional<std::string> find_archive(const std::string& name);
    /// Whether a file may be there that scenes must not reach.
    bool is_closed(const std::string& name) const { return access_.is_closed(name, files_.current_folder()); }

  private:
    std::optional<std::string> find_archive_named(const std::string& name) const;

    Access& access_;
    RequestReport& report_;
    GraphicsStateStack& state_;
    const OpenFiles& files_;
    bool is_trusted_ = false;
};

}  // namespace trapeze::rib
