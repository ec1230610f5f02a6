#include "pipeline/rib/state/saved_states.h"

namespace trapeze::rib {
namespace {

// Against files that nest or save without end.
constexpr size_t kDeepestResources = 1000;
constexpr size_t kMostSavedStates = 10000;

}  // namespace

/// A name that is there is replaced.
void SavedStates::save(const std::string& name, const GraphicsState& state) {
    if (states_->size() >= kMostSavedStates && !states_->contains(name))
        throw RequestError{"more than " + std::to_string(kMostSavedStates) + " resources", {}};
    if (states_.use_count() > 1) states_ = std::make_shared<States>(*states_);
    const_cast<States&>(*states_)[name] = state;
}

/// Holds until the next save(), or the end of the block.
const GraphicsState* SavedStates::find(const std::string& name) const {
    const auto saved = states_->find(name);
    return saved == states_->end() ? nullptr : &saved->second;
}

/// The names are shared with the block around it until one of the two saves.
void SavedStates::begin_block() {
    if (outer_.size() >= kDeepestResources)
        throw RequestError{"blocks are nested more than " + std::to_string(kDeepestResources) + " deep", {}};
    outer_.push_back(states_);
}

/// Names that the block saved are dropped with it, and those that it replaced are what they were.
void SavedStates::end_block() {
    if (outer_.empty()) throw RequestError{"no ResourceBegin is open", {}};
    states_ = std::move(outer_.back());
    outer_.pop_back();
}

}  // namespace trapeze::rib
