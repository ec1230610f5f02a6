/// The viewer tev, which a run sends its pictures to.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <thread>

#include "pipeline/preview/patient_socket.h"
#include "pipeline/preview/preview.h"

namespace trapeze {

/// Sends tiles as they are finished. A tev that is not there, went away, or takes nothing for long is asked
/// again now and then.
class TevViewer final : public PreviewViewer {
  public:
    /// `report` is called from the viewer's thread with what is wrong, in one line: once until
    /// something is shown again.
    TevViewer(const PreviewBoard& board, std::string host, int port,
              std::function<void(const std::string&)> report);
    ~TevViewer() override;

    /// Returns when all is sent, nothing has been taken for a second, or the board has no more time.
    void finish() override;

  private:
    void run();
    void show_once_there(const PreviewEntry& entry);
    bool show(const PreviewEntry& entry);
    bool send_changes(const PreviewEntry& entry, const std::vector<int>& channels, uint64_t& version);

    const PreviewBoard& board_;
    const std::string host_;
    const int port_;
    const std::function<void(const std::string&)> report_;
    bool fails_ = false;     ///< it is said already that nothing is shown
    bool gives_up_ = false;  ///< the run has ended, and waits for a tev that takes nothing
    PatientSocket socket_;
    std::thread thread_;
};

}  // namespace trapeze
