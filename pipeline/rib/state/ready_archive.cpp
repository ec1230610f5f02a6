#include "pipeline/rib/state/ready_archive.h"

#include <sys/stat.h>

#include "pipeline/rib/state/same_shape.h"

namespace trapeze::rib {
namespace {

/// About: 256 for what each request has in any case.
uint64_t bytes_of(const RequestText& request) {
    uint64_t bytes = 256 + request.name.size() + request.problem.size();
    for (const Argument& argument : request.arguments) {
        bytes += sizeof argument + argument.floats.size() * sizeof(float) +
                 argument.large_integers.size() * sizeof(argument.large_integers[0]);
        for (const std::string& string : argument.strings) bytes += sizeof string + string.size();
    }
    return bytes;
}

}  // namespace

/// A file that was written anew has another number, size or time.
std::optional<FileStamp> stamp_of(const std::string& path) {
    struct stat status {};
    if (stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return {};
    return FileStamp{status.st_dev, status.st_ino, static_cast<uint64_t>(status.st_size),
                     status.st_mtim.tv_sec, status.st_mtim.tv_nsec};
}

/// An archive that would take more than is left is given up as a whole: half of one is of no use.
void ReadyArchive::add(const RequestText& request) {
    if (is_given_up_) return;
    const uint64_t bytes = bytes_of(request);
    if (bytes > *bytes_left_) return give_up();
    *bytes_left_ -= bytes, taken_ += bytes;
    requests_.push_back(
        {request.name, request.at, request.arguments, request.problem, request.problem_at, {}});
}

/// What it took can serve other archives.
void ReadyArchive::give_up() {
    is_given_up_ = true, is_complete_ = false;
    *bytes_left_ += taken_;
    taken_ = 0;
    requests_ = {};
}

/// Places are those of this reading, so that messages say through which ReadArchive the request came.
void ReadyArchive::copy(size_t index, uint32_t source, RequestText& request) const {
    const Known& known = requests_[index];
    request.clear();
    request.name = known.name, request.problem = known.problem;
    request.arguments = known.arguments;
    request.at = known.at, request.problem_at = known.problem_at;
    request.at.source = source;
    if (request.problem_at.line > 0) request.problem_at.source = source;
    for (Argument& argument : request.arguments) argument.at.source = source;
}

/// Shapes are held weakly: an archive that is known keeps none alive that no scene has.
bool ReadyArchive::share(size_t index, size_t ordinal, std::shared_ptr<const Shape>& shape) {
    if (index >= requests_.size()) return false;
    std::vector<std::weak_ptr<const Shape>>& shapes = requests_[index].shapes;
    if (ordinal >= shapes.size()) shapes.resize(ordinal + 1);
    if (auto earlier = shapes[ordinal].lock(); earlier && is_same(*earlier, *shape)) {
        shape = std::move(earlier);
        return true;
    }
    shapes[ordinal] = shape;
    return false;
}

}  // namespace trapeze::rib
