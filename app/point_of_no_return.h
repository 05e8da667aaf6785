#pragma once
#include <atomic>

namespace lodestone {

// Decides between a job that is about to do what cannot be undone (a file takes another's place)
// and whoever cancels it: the first wins, and each of them knows. Any thread.
class PointOfNoReturn {
public:
    // The job: true: from now on it cannot be cancelled; false: it is.
    bool pass() { return settle(State::Passed); }

    // Cancelling it: true: it will not pass; false: it has passed.
    bool close() { return settle(State::Closed); }

private:
    enum class State : unsigned char { Open, Passed, Closed };

    bool settle(State wanted) {
        State before = State::Open;
        return state_.compare_exchange_strong(before, wanted) || before == wanted;
    }

    std::atomic<State> state_{State::Open};
};

} // namespace lodestone
