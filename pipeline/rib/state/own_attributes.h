/// What the definition of an object has set: its instances have the rest.
#pragma once

#include <bitset>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/scene.h"

namespace trapeze::rib {

struct AttributeState;

/// What a request sets as a whole.
enum class Own : uint8_t {
    Color,
    Opacity,
    TextureCoordinates,
    ShadingRate,
    ShadingInterpolation,
    Matte,
    Sides,
    Surface,
    Displacement,
    Atmosphere,
    Interior,
    Exterior,
    Emitter,
    MotionFactor,
    FocusFactor,
    DetailRange,
    DisplacementBound,  ///< both values of it
    Rays,               ///< all of RayAttributes
    Name,
};
inline constexpr size_t kOwns = static_cast<size_t>(Own::Name) + 1;

/// A value of Attribute.
struct AttributeValue {
    std::string category;
    Parameter value;
};

/// A record of requests, not of differences: an attribute that was set to the value it had is the object's
/// own. What changes a part of something is kept as it was said, for each instance to do to what it has.
class OwnAttributes {
  public:
    /// Of lights that Illuminate has named, whether they are on.
    using Switches = std::vector<std::pair<std::shared_ptr<const LightInstance>, bool>>;

    OwnAttributes() = default;
    /// `definition`: the id of its block.
    explicit OwnAttributes(uint64_t definition) : definition_(definition) {}
    /// Of a state from elsewhere that was restored (Resource): all of it is the object's own.
    OwnAttributes(uint64_t definition, std::shared_ptr<const AttributeState> restored)
        : definition_(definition), restored_(std::move(restored)) {}

    /// 0: this is no definition's record.
    uint64_t definition() const { return definition_; }
    const AttributeState* restored() const { return restored_.get(); }
    bool has(Own what) const { return whole_.test(static_cast<size_t>(what)); }
    /// By when they were set.
    using Values = std::map<uint64_t, AttributeValue>;
    const Values& values() const;
    const Switches& switches() const { return switches_; }

    void set(Own what) { whole_.set(static_cast<size_t>(what)); }
    /// A value comes after those that were set before. What it undoes is not kept: primitives may have names
    /// by the thousand.
    void set(const std::string& category, const Parameter& value);
    void switch_light(const std::shared_ptr<const LightInstance>& light, bool on);
    /// What a definition takes over from an instance of another object in it.
    void add(const OwnAttributes& other);

  private:
    struct Record {
        Values values;
        uint64_t next = 0;
        std::map<std::string, std::set<uint64_t>> of_name;  ///< by category and name: which of the values
    };

    uint64_t definition_ = 0;
    std::bitset<kOwns> whole_;
    std::shared_ptr<Record> record_;  ///< shared until a value is set; null: none
    Switches switches_;
    std::shared_ptr<const AttributeState> restored_;
};

}  // namespace trapeze::rib
