// Status and StatusOr: every fallible function of Lacerta returns one of them, and none throws.
#ifndef LACERTA_STATUS_H_
#define LACERTA_STATUS_H_

#include <cassert>
#include <optional>
#include <string>
#include <utility>

namespace lacerta {

enum class StatusCode {
  kOk = 0,
  kInvalidArgument,   // an option or a value that the caller passed
  kInvalidData,       // a file or stream that breaks its format
  kUnsupported,       // legal, but not handled by this version
  kLimitExceeded,     // would exceed a decode or memory budget
  kNotFound,          // a file or object that is not there
  kIoError,           // reading or writing failed
  kInternal,          // a bug of ours
};

// Result of an operation: a code and, when not ok, a message that names what was wrong and what to do about it.
#ifndef LACERTA_TERSE
class [[nodiscard]] Status {
 public:
  Status() = default;
  Status(StatusCode code, std::string message) : code_(code), message_(std::move(message)) {}

  bool ok() const { return code_ == StatusCode::kOk; }
  StatusCode code() const { return code_; }
  const std::string& message() const { return message_; }

  // The same status with "context: " put before the message; an ok status stays ok.
  Status WithContext(const std::string& context) const {
    return ok() ? *this : Status(code_, context + ": " + message_);
  }

 private:
  StatusCode code_ = StatusCode::kOk;
  std::string message_;
};

inline Status InvalidArgument(std::string message) { return {StatusCode::kInvalidArgument, std::move(message)}; }
inline Status InvalidData(std::string message) { return {StatusCode::kInvalidData, std::move(message)}; }
inline Status Unsupported(std::string message) { return {StatusCode::kUnsupported, std::move(message)}; }
inline Status LimitExceeded(std::string message) { return {StatusCode::kLimitExceeded, std::move(message)}; }
inline Status NotFound(std::string message) { return {StatusCode::kNotFound, std::move(message)}; }
inline Status IoError(std::string message) { return {StatusCode::kIoError, std::move(message)}; }
inline Status InternalError(std::string message) { return {StatusCode::kInternal, std::move(message)}; }
#else
// For builds where every byte counts, as in WebAssembly: a code alone. Texts are not even put together, hence the macros.
class [[nodiscard]] Status {
 public:
  Status() = default;
  explicit Status(StatusCode code) : code_(code) {}

  bool ok() const { return code_ == StatusCode::kOk; }
  StatusCode code() const { return code_; }
  std::string message() const { return {}; }
  const Status& AsItIs() const { return *this; }

 private:
  StatusCode code_ = StatusCode::kOk;
};

#define WithContext(...) AsItIs()
#define InvalidArgument(...) Status(::lacerta::StatusCode::kInvalidArgument)
#define InvalidData(...) Status(::lacerta::StatusCode::kInvalidData)
#define Unsupported(...) Status(::lacerta::StatusCode::kUnsupported)
#define LimitExceeded(...) Status(::lacerta::StatusCode::kLimitExceeded)
#define InternalError(...) Status(::lacerta::StatusCode::kInternal)
#endif

// A value, or the status that says why there is none. The value may be taken only after ok() was seen.
template <typename T>
class [[nodiscard]] StatusOr {
 public:
  StatusOr(T value) : value_(std::move(value)) {}                  // NOLINT: implicit on purpose
  StatusOr(Status status) : status_(std::move(status)) {           // NOLINT
    assert(!status_.ok());
  }

  bool ok() const { return value_.has_value(); }
  Status status() const { return status_; }
  const T& value() const& { return *value_; }
  T& value() & { return *value_; }
  T&& value() && { return std::move(*value_); }

 private:
  Status status_;  // two members, not one variant, whose code takes twice the bytes in WebAssembly
  std::optional<T> value_;
};

#define LACERTA_CONCAT_INNER(a, b) a##b
#define LACERTA_CONCAT(a, b) LACERTA_CONCAT_INNER(a, b)

// Returns from the calling function when `expression`, a Status, is not ok.
#define LACERTA_RETURN_IF_ERROR(expression)                       \
  do {                                                            \
    if (::lacerta::Status lacerta_status = (expression); !lacerta_status.ok()) return lacerta_status; \
  } while (false)

// Assigns the value of `expression`, a StatusOr, to `target` or returns its status from the calling function.
#define LACERTA_ASSIGN_OR_RETURN(target, expression) \
  LACERTA_ASSIGN_OR_RETURN_INNER(LACERTA_CONCAT(lacerta_result_, __LINE__), target, expression)
#define LACERTA_ASSIGN_OR_RETURN_INNER(result, target, expression) \
  auto result = (expression);                                      \
  if (!result.ok()) return result.status();                        \
  target = std::move(result).value()

}  // namespace lacerta

#endif  // LACERTA_STATUS_H_
