/// Pictures that `-o` writes in another form than their Displays ask for, kept as these do: a map that the
/// input makes of one later is made of all that was in it.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "composite/image.h"
#include "core/files/access.h"
#include "core/files/scratch_folder.h"
#include "core/scene/render_context.h"

namespace trapeze {

/// The last pictures of a run: the very last in memory, where that of an input with one world stays, the
/// others in files that go away with the object.
class PassPictures {
  public:
    /// Keeps a picture of the context, for whose first Display the scene has `display`.
    void keep(const Display& display, const RenderContext& context, Image image);
    /// Writes the picture that is in memory to a file: another one is about to be made. One that cannot be
    /// written is not kept.
    void write_last();
    /// The file of the picture whose Display has this name; nothing when none is kept.
    std::optional<std::string> file_of(const std::string& name);
    /// Drops the picture of this name: there is a file of that name now.
    void forget(const std::string& name);
    /// Lets maps be made of the files.
    void allow_reading(Access& access) const;

  private:
    struct Picture {
        Scene scene;  ///< of options alone
        RenderContext context;
        Image image;
    };
    struct File {
        std::string name, path;
    };

    std::unique_ptr<Picture> last_;
    std::deque<File> files_;
    ScratchFolder folder_;
};

}  // namespace trapeze
