/// A config whose colours can be worked out by hand.
#pragma once

#include <fstream>
#include <string>

#include "core/files/temporary_folder_harness.h"

namespace trapeze::testing {

/// Display "screen": view "mixed" is the squares of (r/2 + g/4, g, b/2), view "brighter" is that of twice the
/// colours (look "double"), view "plain" changes nothing. "paint" holds the square roots of the working space
/// "work"; files called *_paint.* are in it by the config's rules.
inline constexpr const char* kSmallConfig = R"(ocio_profile_version: 2
roles:
  default: work
  scene_linear: work
file_rules:
  - !<Rule> {name: paint, colorspace: paint, pattern: "*_paint", extension: "*"}
  - !<Rule> {name: Default, colorspace: default}
displays:
  screen:
    - !<View> {name: mixed, colorspace: mixed}
    - !<View> {name: brighter, colorspace: mixed, looks: double}
    - !<View> {name: plain, colorspace: raw}
  Projector:
    - !<View> {name: dark, colorspace: mixed}
looks:
  - !<Look>
    name: double
    process_space: work
    transform: !<MatrixTransform> {matrix: [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1]}
colorspaces:
  - !<ColorSpace> {name: work, encoding: scene-linear}
  - !<ColorSpace> {name: raw, isdata: true}
  - !<ColorSpace>
    name: mixed
    from_scene_reference: !<GroupTransform>
      children:
        - !<MatrixTransform> {matrix: [0.5, 0.25, 0, 0, 0, 1, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]}
        - !<ExponentTransform> {value: [2, 2, 2, 1]}
  - !<ColorSpace>
    name: paint
    aliases: [painted]
    to_scene_reference: !<ExponentTransform> {value: [2, 2, 2, 1]}
  - !<ColorSpace>
    name: lost
    from_scene_reference: !<FileTransform> {src: lost.spi1d}
)";

/// Writes the config, or another text, to a file of the folder. Returns its path.
inline std::string write_config(const TemporaryFolder& folder, const std::string& text = kSmallConfig) {
    const std::string path = folder.file("small.ocio");
    std::ofstream(path) << text;
    return path;
}

}  // namespace trapeze::testing
