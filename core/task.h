/// Functions that may wait for others, as deep as memory reaches: what a waiting function knows is kept on
/// the heap, and the thread's stack is the same at every depth. Rays whose hits send rays are followed so.
#pragma once

#include <coroutine>
#include <exception>
#include <optional>
#include <type_traits>
#include <utility>

namespace trapeze {

namespace tasks {

/// What a thread goes on with when a task has begun to wait, or has ended; null: all have ended.
struct Line {
    std::coroutine_handle<> next;
};

/// What all tasks keep.
struct Promise {
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
