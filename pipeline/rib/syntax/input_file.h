/// A C stream that is read, closed with its owner.
#pragma once

#include <cstdio>
#include <memory>

namespace trapeze::rib {

/// Standard input is not ours to close.
struct CloseInput {
    void operator()(std::FILE* file) const {
        if (file != stdin) std::fclose(file);
    }
};

/// Null where the file could not be opened; errno says why.
using InputFile = std::unique_ptr<std::FILE, CloseInput>;

}  // namespace trapeze::rib
