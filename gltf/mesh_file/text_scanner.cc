#include "mesh_file/text_scanner.h"

#include <charconv>
#include <limits>
#include <system_error>

namespace lacerta {
namespace {

bool IsLineEnd(char c) { return c == '\n' || c == '\r'; }
bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

std::string_view WithoutPlus(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  return word;
}

}  // namespace

std::string_view TakeWord(std::string_view* rest) {
  size_t begin = 0;
  while (begin < rest->size() && (IsBlank((*rest)[begin]) || IsLineEnd((*rest)[begin]))) ++begin;
  size_t end = begin;
  while (end < rest->size() && !IsBlank((*rest)[end]) && !IsLineEnd((*rest)[end])) ++end;
  const std::string_view word = rest->substr(begin, end - begin);
  rest->remove_prefix(end);
  return word;
}

std::string RestOfLine(std::string_view rest) {
  while (!rest.empty() && IsBlank(rest.front())) rest.remove_prefix(1);
  while (!rest.empty() && IsBlank(rest.back())) rest.remove_suffix(1);
  return std::string(rest);
}

bool ParseDouble(std::string_view word, double* value) {
  word = WithoutPlus(word);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), *value);
  if (end != word.data() + word.size()) return false;
  if (error == std::errc::result_out_of_range) {
    // from_chars leaves the value alone; too small a number is 0, too large a one infinite.
    const bool tiny =
        word.find("e-") != word.npos || word.find("E-") != word.npos || word.find_first_of("eE") == word.npos;
    *value = tiny ? 0.0 : std::numeric_limits<double>::infinity();
    return true;
  }
  return error == std::errc();
}

bool ParseInt(std::string_view word, int64_t* value) {
  word = WithoutPlus(word);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), *value);
  return error == std::errc() && end == word.data() + word.size();
}

void TextScanner::SkipLineEnd() {
  if (rest_.empty()) return;
  const bool two = rest_.size() > 1 && rest_[0] == '\r' && rest_[1] == '\n';
  rest_.remove_prefix(two ? 2 : 1);
  ++ends_passed_;
}

bool TextScanner::NextLine(std::string_view* line) {
  if (rest_.empty()) return false;
  line_ = ends_passed_ + 1;
  size_t length = 0;
  while (length < rest_.size() && !IsLineEnd(rest_[length])) ++length;
  *line = rest_.substr(0, length);
  rest_.remove_prefix(length);
  SkipLineEnd();
  return true;
}

bool TextScanner::NextWord(std::string_view* word) {
  while (!rest_.empty() && (IsBlank(rest_[0]) || IsLineEnd(rest_[0]))) {
    if (IsLineEnd(rest_[0])) {
      SkipLineEnd();
    } else {
      rest_.remove_prefix(1);
    }
  }
  if (rest_.empty()) return false;
  line_ = ends_passed_ + 1;
  *word = TakeWord(&rest_);
  return true;
}

}  // namespace lacerta
