#pragma once

namespace trapeze {

/// The revision of the source that was built, as `git describe` names it; the version where git was not
/// there.
const char* revision();

}  // namespace trapeze
