#include "pipeline/ri/rib_output.h"

namespace trapeze::ri {

RibOutput::RibOutput(const std::string& name, RibFormat format) {
    const auto encoding = format.binary ? rib::RibEncoding::Binary : rib::RibEncoding::Ascii;
    if (name.empty()) {
        writer_ =
            std::make_unique<rib::RibWriter>(encoding, [this](std::string_view bytes) { text_ += bytes; });
        return;
    }
    file_.emplace(name);
    good_ = file_->open();
    if (format.gzip) gzip_.emplace([this](std::string_view bytes) { write(bytes); });
    writer_ = std::make_unique<rib::RibWriter>(encoding, [this](std::string_view bytes) {
        if (gzip_)
            gzip_->add(bytes);
        else
            write(bytes);
    });
}

void RibOutput::write(std::string_view bytes) {
    good_ = good_ && file_->write(bytes.data(), bytes.size());
}

const std::string& RibOutput::text() {
    writer_->flush();
    return text_;
}

bool RibOutput::commit() {
    writer_->flush();
    if (gzip_) gzip_->finish();
    return good_ && file_->commit();
}

const std::string& RibOutput::error() const {
    static const std::string kNone;
    return file_ ? file_->error() : kNone;
}

}  // namespace trapeze::ri
