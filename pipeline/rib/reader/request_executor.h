/// What happens to each request that is read, up to its handler.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/rib/reader/known_requests.h"
#include "pipeline/rib/reader/request_context.h"

namespace trapeze::rib {

/// Looks requests up, counts them, keeps those back that a motion block holds, calls handlers, and says what
/// is wrong with the others.
class RequestExecutor {
  public:
    RequestExecutor(const ReadOptions& options, RequestReport& report, MotionCollector& motion,
                    const ConditionalBlocks& conditions, const SceneBuilder& scene, RequestContexts& contexts)
        : read_options_(options),
          report_(report),
          motion_(motion),
          conditions_(conditions),
          scene_(scene),
          contexts_(contexts) {}
    RequestExecutor(const RequestExecutor&) = delete;
    RequestExecutor& operator=(const RequestExecutor&) = delete;

    /// A request as it stands in the stream. Its text may be changed, and its memory taken.
    void execute(RequestText& text);
    /// One that a motion block has held back, at the times of that block.
    void execute_held(const std::vector<RequestText>& keys, const std::vector<float>& times);
    /// Tells ReadOptions::on_request of a request; whether it is to be carried out.
    bool hands_on(const RequestText& text) const;

  private:
    void carry_out(const Request& request, RequestText& text);

    const ReadOptions& read_options_;
    RequestReport& report_;
    MotionCollector& motion_;
    const ConditionalBlocks& conditions_;
    const SceneBuilder& scene_;
    RequestContexts& contexts_;
    /// Where the summary counts requests of this name; no search by name for each of a million requests.
    uint64_t& count_of(const Request& request);

    /// Of the requests that have come, by their numbers, where the summary counts them; else null.
    std::vector<uint64_t*> counts_;
};

}  // namespace trapeze::rib
