/// Members of zip archives: RenderMan's exporters keep geometry as "job.zip!folder/name.rib".
#pragma once

#include <optional>
#include <string>

#include "core/files/access.h"

namespace trapeze::rib {

/// "job.zip" and "folder/name.rib" of "job.zip!folder/name.rib"; nothing for other names.
struct ZipMember {
    std::string archive, member;
};

/// By the name alone: neither the archive nor the member need be there.
std::optional<ZipMember> zip_member_named(const std::string& path);

/// The member's bytes, stored or deflated; never more than max_bytes. Otherwise nothing, and why. Archives
/// that need the 64-bit form or a password are not read.
std::optional<std::string> read_zip_member(const ZipMember& member, size_t max_bytes, std::string* error,
                                           const Access& access = kEverything);
/// Whether it is there.
bool has_zip_member(const ZipMember& member, const Access& access);

}  // namespace trapeze::rib
