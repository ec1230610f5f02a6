/// Where OpenEXR's library writes to: a file that appears whole or not at all.
#pragma once

#include <OpenEXR/ImfIO.h>

#include <stdexcept>
#include <string>

#include "core/files/output_file.h"

namespace trapeze {

/// A stream, as OpenEXR wants it, on a file of ours. OutputFile remembers failures that OpenEXR's destructors
/// swallow.
class ExrStream : public Imf::OStream {
  public:
    ExrStream(OutputFile& file, const std::string& name) : Imf::OStream(name.c_str()), file_(file) {}

    void write(const char bytes[], int count) override {
        check(file_.write(bytes, static_cast<size_t>(count)));
    }
    uint64_t tellp() override { return file_.position(); }
    void seekp(uint64_t position) override { check(file_.seek(position)); }

  private:
    void check(bool good) const {
        if (!good) throw std::runtime_error(file_.error());
    }
    OutputFile& file_;
};

/// Opens `file`, lets write() fill it, which may throw, and commits it. Returns what went wrong, or nothing.
template <class Write>
std::string write_whole(OutputFile& file, const Write& write) {
    if (!file.open()) return file.error();
    try {
        write();
    } catch (const std::exception& failure) {
        return file.error().empty() ? failure.what() : file.error();
    }
    return file.commit() ? std::string() : file.error();
}

}  // namespace trapeze
