/// PRMan's Resource: graphics states saved under names, which no block restores but ResourceBegin's own.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/rib/state/graphics_state.h"

namespace trapeze::rib {

/// Blocks share their names until one of them adds some: files open thousands.
class SavedStates {
  public:
    /// Throws a RequestError when there are too many.
    void save(const std::string& name, const GraphicsState& state);
    /// Null when there is none of that name.
    const GraphicsState* find(const std::string& name) const;

    /// ResourceBegin and ResourceEnd: names of the block end with it. Throw a RequestError when blocks nest
    /// too deeply, or none is open.
    void begin_block();
    void end_block();

  private:
    using States = std::map<std::string, GraphicsState>;
    std::shared_ptr<const States> states_ = std::make_shared<States>();
    std::vector<std::shared_ptr<const States>> outer_;
};

}  // namespace trapeze::rib
