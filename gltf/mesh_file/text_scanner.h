// Lines, words and numbers of a text file that is already in memory. Locale plays no part.
#ifndef LACERTA_MESH_FILE_TEXT_SCANNER_H_
#define LACERTA_MESH_FILE_TEXT_SCANNER_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace lacerta {

// Takes the first word off `*rest`; empty when there is none left.
std::string_view TakeWord(std::string_view* rest);

// What is left without blanks before and after it: a name that may have some within.
std::string RestOfLine(std::string_view rest);

// The whole word as a number. "nan" and "inf" are numbers here; a value beyond the range of double becomes infinite.
bool ParseDouble(std::string_view word, double* value);
bool ParseInt(std::string_view word, int64_t* value);

class TextScanner {
 public:
  explicit TextScanner(std::string_view text) : rest_(text) {}

  // The next line without its end (\n, \r\n or \r); false at the end of the text.
  bool NextLine(std::string_view* line);
  // The next word, on whatever line; false at the end of the text.
  bool NextWord(std::string_view* word);

  // Number of the line that the last word or line came from, counted from 1.
  size_t line() const { return line_; }
  std::string LineName() const { return "line " + std::to_string(line_); }
  size_t bytes_left() const { return rest_.size(); }
  std::string_view rest() const { return rest_; }

 private:
  void SkipLineEnd();

  std::string_view rest_;
  size_t line_ = 0;         // of what was returned last
  size_t ends_passed_ = 0;  // line ends consumed so far
};

}  // namespace lacerta

#endif  // LACERTA_MESH_FILE_TEXT_SCANNER_H_
