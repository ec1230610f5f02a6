/// PRMan's Resource: attributes saved under a name.
#include "pipeline/rib/reader/reader.h"

namespace trapeze::rib {
namespace {

constexpr size_t kDeepestResources = 1000;
constexpr size_t kMostSavedStates = 10000;

}  // namespace

void Reader::save_state(const std::string& name) {
    if (saved_states_->size() >= kMostSavedStates && !saved_states_->contains(name))
        throw RequestError{"more than " + std::to_string(kMostSavedStates) + " resources", {}};
    if (saved_states_.use_count() > 1) saved_states_ = std::make_shared<SavedStates>(*saved_states_);
    const_cast<SavedStates&>(*saved_states_)[name] = state_;
}

bool Reader::restore_state(const std::string& name, bool attributes, bool transform) {
    if (motion_) throw RequestError{"inside a motion block", {}};
    const auto saved = saved_states_->find(name);
    if (saved == saved_states_->end()) return false;
    if (attributes) state_.attributes = saved->second.attributes;
    if (transform) state_.transform = saved->second.transform;
    return true;
}

void Reader::begin_resources() {
    if (saved_states_blocks_.size() >= kDeepestResources)
        throw RequestError{"blocks are nested more than " + std::to_string(kDeepestResources) + " deep", {}};
    saved_states_blocks_.push_back(saved_states_);
}

void Reader::end_resources() {
    if (saved_states_blocks_.empty()) throw RequestError{"no ResourceBegin is open", {}};
    saved_states_ = std::move(saved_states_blocks_.back());
    saved_states_blocks_.pop_back();
}

}  // namespace trapeze::rib
