/// Others that do not answer: a connection waits for none of them longer than it may.
#include "pipeline/preview/patient_socket.h"

#include <gtest/gtest.h>
#include <netdb.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "pipeline/preview/mock_tev_harness.h"

namespace trapeze {
namespace {

using testing::MockTev;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

std::atomic<bool> name_server_is_dead{false};
std::atomic<int> lookups_ended{0};

/// A name server that says nothing for as long as it is dead, then that there is no such host.
int look_up_in_vain(const char*, const char*, const addrinfo* wanted, addrinfo**) {
    if (wanted->ai_flags & AI_NUMERICHOST) return EAI_NONAME;
    while (name_server_is_dead) std::this_thread::sleep_for(1ms);
    ++lookups_ended;
    return EAI_AGAIN;
}

TEST(PatientSocket, ADeadNameServerIsWaitedForNoLongerThanItMayBe) {
    name_server_is_dead = true;
    lookups_ended = 0;
    PatientSocket socket([] { return 100ms; }, look_up_in_vain);
    EXPECT_FALSE(socket.connect("nowhere", 1));
    EXPECT_EQ(socket.problem(), "nobody says where it is");
    EXPECT_EQ(lookups_ended, 0);
    name_server_is_dead = false;
    while (lookups_ended == 0) std::this_thread::yield();
    PatientSocket patient([] { return 60s; }, look_up_in_vain);
    EXPECT_FALSE(patient.connect("nowhere", 1));
    EXPECT_EQ(patient.problem(), gai_strerror(EAI_AGAIN));
}

TEST(PatientSocket, OneThatTakesALittleNowAndThenIsLeftWhenTimeIsOver) {
    MockTev tev(MockTev::kAll, MockTev::Reads::LittleByLittle);
    Clock::time_point until = Clock::now() + 60s;
    PatientSocket socket([&] {
        return std::max(0ms, std::chrono::duration_cast<std::chrono::milliseconds>(until - Clock::now()));
    });
    ASSERT_TRUE(socket.connect("127.0.0.1", tev.port()));
    const std::string bytes(size_t{64} << 20, 'x');
    until = Clock::now() + 500ms;
    EXPECT_FALSE(socket.send(bytes));
    EXPECT_FALSE(socket.is_open());
    EXPECT_EQ(socket.problem(), "it takes nothing any more");
    tev.stop();
}

}  // namespace
}  // namespace trapeze
