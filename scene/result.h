#pragma once
// Expected failures are values. Exceptions of libraries are caught where the library is called.
#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace lodestone {

// What went wrong, as the exit code tells it.
enum class ErrorKind {
    Failed,    // 1: failed while working
    Usage,     // 2: wrong usage
    BadInput,  // 3: unreadable or invalid input
    Cancelled, // 130: interrupted
};

// One line for people: file, object, fault, remedy. No line break, no trailing full stop.
struct Error {
    ErrorKind kind = ErrorKind::Failed;
    std::string message;
};

template <class T>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> fail(ErrorKind kind, std::string message) {
    return tl::unexpected<Error>(Error{kind, std::move(message)});
}

inline tl::unexpected<Error> badInput(std::string message) {
    return fail(ErrorKind::BadInput, std::move(message));
}

inline tl::unexpected<Error> cancelled() {
    return fail(ErrorKind::Cancelled, "cancelled");
}

// The process exit code of an error.
int exitCode(ErrorKind kind);

} // namespace lodestone
