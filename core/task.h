/// Functions that may wait for others, as deep as memory reaches: what a waiting function knows is kept on
/// the heap, and the thread's stack is the same at every depth. Rays whose hits send rays are followed so.
#pragma once

#include <array>
#include <coroutine>
#include <cstddef>
#include <exception>
#include <new>
#include <optional>
#include <type_traits>
#include <utility>

namespace trapeze {

namespace tasks {

/// What a thread goes on with when a task has begun to wait, or has ended; null: all have ended.
struct Line {
    std::coroutine_handle<> next;
};

/// Memory of tasks that have ended, a thread's, for the next ones: shading a grid is half a dozen tasks,
/// which take less time than as many calls of the allocator.
class FreeTasks {
  public:
    FreeTasks() = default;
    FreeTasks(const FreeTasks&) = delete;
    FreeTasks& operator=(const FreeTasks&) = delete;
    /// Tasks that end later in the thread are taken for more than enough.
    ~FreeTasks() {
        for (List& list : lists_) {
            while (list.first) ::operator delete(std::exchange(list.first, list.first->next));
            list.count = kMost;
        }
    }

    void* take(size_t bytes) {
        const size_t number = list_of(bytes);
        if (number >= kLists) return ::operator new(bytes);
        List& list = lists_[number];
        if (!list.first) return ::operator new((number + 1) * kStep);
        --list.count;
        return std::exchange(list.first, list.first->next);
    }
    void give_back(void* frame, size_t bytes) noexcept {
        const size_t number = list_of(bytes);
        if (number >= kLists || lists_[number].count == kMost) return ::operator delete(frame);
        List& list = lists_[number];
        list.first = new (frame) Free{list.first};
        ++list.count;
    }

  private:
    struct Free {
        Free* next;
    };
    struct List {
        Free* first = nullptr;
        size_t count = 0;
    };
    /// Frames of up to 64, 128, ... 2048 bytes.
    static constexpr size_t kStep = 64, kLists = 32;
    /// So many of each size are kept; none where sanitizers are to see what becomes of them.
#if defined(TRAPEZE_SANITIZED)
    static constexpr size_t kMost = 0;
#else
    static constexpr size_t kMost = 32;
#endif
    static size_t list_of(size_t bytes) {
        return (bytes - 1) / kStep;
    }

    std::array<List, kLists> lists_{};
};

inline FreeTasks& free_tasks() {
    static thread_local FreeTasks frames;
    return frames;
}

/// What all tasks keep.
struct Promise {
    static void* operator new(size_t bytes) { return free_tasks().take(bytes); }
    static void operator delete(void* frame, size_t bytes) noexcept { free_tasks().give_back(frame, bytes); }

    /// Goes on with the task that waits for the one that has ended.
    struct End {
        bool await_ready() const noexcept { return false; }
        template <class Ended>
        void await_suspend(std::coroutine_handle<Ended> ended) const noexcept {
            ended.promise().line->next = ended.promise().waiting;
        }
        void await_resume() const noexcept {}
    };

    Line* line = nullptr;
    std::coroutine_handle<> waiting;
    std::exception_ptr thrown;

    std::suspend_always initial_suspend() const noexcept { return {}; }
    End final_suspend() const noexcept { return {}; }
    void unhandled_exception() noexcept { thrown = std::current_exception(); }
    void rethrow() const {
        if (thrown) std::rethrow_exception(thrown);
    }
};

template <class T>
struct PromiseOf : Promise {
    std::optional<T> value;

    void return_value(T made) { value.emplace(std::move(made)); }
    T take() {
        rethrow();
        return std::move(*value);
    }
};

template <>
struct PromiseOf<void> : Promise {
    void return_void() const noexcept {}
    void take() const { rethrow(); }
};

}  // namespace tasks

/// A call of a function that returns Task<T> and says `co_await task` where it waits for another and
/// `co_return` where it ends. It begins when somebody waits for it, is run by one thread, and throws there
/// what was thrown in it. References that it is given must outlive it, as those of any call that is waited
/// for do.
template <class T = void>
class [[nodiscard]] Task {
  public:
    struct promise_type : tasks::PromiseOf<T> {
        Task get_return_object() noexcept {
            return Task(std::coroutine_handle<promise_type>::from_promise(*this));
        }
    };

    Task(Task&& other) noexcept : call_(std::exchange(other.call_, {})) {}
    Task& operator=(Task&&) = delete;
    ~Task() {
        if (call_) call_.destroy();
    }

    /// Runs it to its end, with all it waits for, for one that is not a task itself.
    T get() && {
        tasks::Line line{call_};
        call_.promise().line = &line;
        while (line.next) std::exchange(line.next, {}).resume();
        return call_.promise().take();
    }

    // What co_await asks for.
    bool await_ready() const noexcept { return false; }
    template <class Asking>
    void await_suspend(std::coroutine_handle<Asking> asking) noexcept {
        call_.promise().line = asking.promise().line;
        call_.promise().waiting = asking;
        asking.promise().line->next = call_;
    }
    T await_resume() { return call_.promise().take(); }

  private:
    explicit Task(std::coroutine_handle<promise_type> call) noexcept : call_(call) {}

    std::coroutine_handle<promise_type> call_;
};

}  // namespace trapeze
