/// The comments of a RIB stream, which say what requests do not: user data records (RISpec 7.4, appendix D).
#pragma once

#include <functional>
#include <string>

namespace trapeze::rib {

/// A line that begins with "##" is a structure hint, other comments are comments.
struct Comment {
    bool is_structure = false;
    std::string text;  ///< behind the mark, up to the line's end
};

/// Calls on_comment for each of a file's (read as source_text.h does), in their order; not for those of
/// archives that it names. False, and why, when the file cannot be read.
bool for_each_comment(const std::string& path, size_t max_bytes,
                      const std::function<void(Comment)>& on_comment, std::string* error);

}  // namespace trapeze::rib
