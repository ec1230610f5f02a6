/// One conversation with a program. Both directions are open at once: a program may answer before it has read
/// all, and one that reads nothing must not stop us.
#include "pipeline/rib/programs/program_answer.h"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "pipeline/rib/programs/end_of_answer.h"

namespace trapeze::rib {
namespace {

using Clock = std::chrono::steady_clock;

/// False at the end of its output. Called where poll() has said that there is something, or the end: it does
/// not wait.
bool read_some(int output, std::string& text) {
    constexpr size_t kReadAtOnce = 65536;
    const size_t old = text.size();
    text.resize(old + kReadAtOnce);
    const ssize_t got = read(output, text.data() + old, kReadAtOnce);
    text.resize(old + static_cast<size_t>(std::max<ssize_t>(got, 0)));
    return got > 0 || (got < 0 && errno == EINTR);
}

/// Measures for how long a program has said nothing.
class Silence {
  public:
    explicit Silence(const AnswerLimits& limits) : limits_(limits) {}

    /// To be called whenever the program has said something.
    void ends() { begin_ = Clock::now(), seconds_said_ = 0; }
    /// Looked at whenever nothing came for a while; tells the listener of each full second.
    bool is_too_long() {
        if (limits_.cancelled && *limits_.cancelled) return true;
        const auto length = Clock::now() - begin_;
        const auto seconds =
            static_cast<int>(std::chrono::duration_cast<std::chrono::seconds>(length).count());
        if (seconds > seconds_said_ && limits_.on_wait) limits_.on_wait(seconds_said_ = seconds);
        return length >= limits_.silence;
    }
    /// At most a fifth of a second, so that a cancelled render ends soon.
    int milliseconds_to_wait() const {
        constexpr std::chrono::milliseconds kLongest{200};
        const auto left =
            std::chrono::duration_cast<std::chrono::milliseconds>(begin_ + limits_.silence - Clock::now());
        return static_cast<int>(std::clamp(left, std::chrono::milliseconds(0), kLongest).count());
    }

  private:
    const AnswerLimits& limits_;
    Clock::time_point begin_ = Clock::now();
    int seconds_said_ = 0;
};

}  // namespace

/// The two directions wait in one poll(): were the request written first, a program that answers while it
/// reads would fill its pipe, and both sides would wait for ever. The input counts as written when the
/// program closes its end; what it then answers is taken all the same.
ProgramAnswer ask_program(int input, int output, const std::string& request, const AnswerLimits& limits) {
    ProgramAnswer answer;
    EndOfAnswer end;
    size_t sent = 0;
    Silence silence(limits);
    while (true) {
        // A negative descriptor makes poll() pass over the input once all of the request is sent.
        pollfd waits[] = {{output, POLLIN, 0}, {sent < request.size() ? input : -1, POLLOUT, 0}};
        const int ready = poll(waits, 2, silence.milliseconds_to_wait());
        if (ready == 0 && silence.is_too_long()) {
            answer.problem = "does not answer";
            return answer;
        }
        if (ready <= 0) continue;  // not yet, or a signal
        if (waits[1].revents != 0) {
            const ssize_t count =
                send(input, request.data() + sent, request.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
            sent = count >= 0                          ? sent + static_cast<size_t>(count)
                   : errno == EAGAIN || errno == EINTR ? sent
                                                       : request.size();  // it reads no more
        }
        if (waits[0].revents == 0) continue;
        const bool goes_on = read_some(output, answer.text);
        silence.ends();
        if (const auto place = end.find(answer.text)) {
            answer.text.resize(*place);
            return answer;
        }
        if (!goes_on) answer.problem = "ended before its answer did (with a byte 0377)";
        if (answer.text.size() > limits.most_bytes) answer.problem = "answers with too much";
        if (!answer.problem.empty()) return answer;
    }
}

}  // namespace trapeze::rib
