/// Compresses a stream of bytes as gzip does.
#pragma once

#include <functional>
#include <memory>
#include <string_view>

namespace trapeze::rib {

/// One stream, from the first byte to finish(). Level 6, as gzip has it.
class GzipWriter {
  public:
    /// `write` takes the compressed bytes as they come. Throws std::bad_alloc.
    explicit GzipWriter(std::function<void(std::string_view)> write);
    ~GzipWriter();
    GzipWriter(const GzipWriter&) = delete;
    GzipWriter& operator=(const GzipWriter&) = delete;

    /// Compressed bytes come when zlib has enough of them, perhaps long after what they stand for.
    void add(std::string_view bytes);
    /// To be called once, at the end.
    void finish();

  private:
    struct State;
    void deflate_all(int flush);

    std::function<void(std::string_view)> write_;
    std::unique_ptr<State> state_;
};

}  // namespace trapeze::rib
