#include "core/files/scratch_folder.h"

#include <stdlib.h>

#include <filesystem>

#include "core/files/output_file.h"

namespace trapeze {

ScratchFolder::~ScratchFolder() {
    for (const std::string& file : files_) OutputFile::remove(file);
    if (!path_.empty()) OutputFile::remove(path_);
}

bool ScratchFolder::make() {
    if (!path_.empty()) return true;
    std::error_code failed;
    const std::filesystem::path temporary = std::filesystem::temp_directory_path(failed);
    if (failed) return false;
    std::string name = (temporary / "trapeze-XXXXXX").string();
    if (!mkdtemp(name.data())) return false;
    path_ = std::move(name);
    OutputFile::remove_at_the_end(path_);
    return true;
}

std::string ScratchFolder::new_file(const std::string& ending) {
    if (!make()) return {};
    const std::string file = path_ + "/" + std::to_string(++count_) + ending;
    OutputFile::remove_at_the_end(file);
    return *files_.insert(file).first;
}

void ScratchFolder::remove(const std::string& file) {
    OutputFile::remove(file);
    files_.erase(file);
}

}  // namespace trapeze
