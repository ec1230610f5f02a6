/// What the command line makes of a world's options and displays, and what the pictures of a run are called.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pipeline/cli/support/arguments.h"
#include "pipeline/cli/support/output_names.h"
#include "pipeline/cli/support/pass_pictures.h"
#include "pipeline/frame/kept_pictures.h"
#include "pipeline/rib/read_rib.h"

namespace trapeze {

/// One for a run, which asks it about its worlds and maps in order.
class WorldOutputs {
  public:
    /// `access` gets the permission to write what the command line names.
    WorldOutputs(const Arguments& arguments, Access& access, Diagnostics& diagnostics);

    /// `pictures`: those that the input makes maps of, where only a tile of a picture is made.
    void set_map_pictures(std::set<std::string> pictures) { map_pictures_ = std::move(pictures); }

    /// Puts the command line's values and names in place of a world's own. Shadow passes keep their options
    /// and displays. Returns whether only a tile is to be made.
    bool prepare(Scene& scene);
    /// Whether the picture has the tile that is to be made; if not, an error says so.
    bool has_tile(const Scene& scene);

    /// The world that was prepared last has written these files. Where it shows nothing, a later one may have
    /// its name.
    void wrote(const std::vector<std::string>& files, bool shows_something);
    /// Whether that world's first picture is written in another form than its Display asks for, so that a map
    /// of it is made of what is kept here; and the name that the scene has for it.
    std::optional<std::string> pass_of(const Scene& scene) const;
    void keep_pass(const RenderContext& context, Image image);

    /// Puts the files that pictures were written to in place of the names that a request for a map has.
    /// False, and reported, where there is none; `access` may read them.
    bool find_pictures(MapRequest& request, Access& access);

    KeptPictures& kept() { return kept_; }

  private:
    void override_options(Options& options) const;
    void override_displays(Scene& scene, bool is_tile);
    void name_output(Scene& scene);
    void name_tile(Options& options);
    void add_asked_aovs(Scene& scene);
    void show_shadow_pass(Options& options);
    bool makes_tile(const Options& options) const;
    bool has_another_form(const Display& display) const;
    bool encode_for_viewing(Display& display, const Options& options) const;

    const Arguments& arguments_;
    const std::optional<PictureTile> tile_;
    Access& access_;
    Diagnostics& diagnostics_;
    KeptPictures kept_;
    OutputNames names_;
    PassPictures passes_;
    std::optional<Display> renamed_;  ///< the world's first display, as the scene has it, if `-o` renames it
    std::set<std::string> encoded_;   ///< by the sRGB curve for viewing: files that `-o` names
    std::set<std::string> map_pictures_;
    std::set<std::string> tiles_made_;  ///< pictures, as the scene calls them, of which only a tile is there
};

}  // namespace trapeze
