// The opaque decoder of lacerta.h in C++ tests.
#ifndef LACERTA_TESTS_PLUGIN_C_DECODER_HANDLE_H_
#define LACERTA_TESTS_PLUGIN_C_DECODER_HANDLE_H_

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "lacerta.h"

namespace lacerta::testing {

struct Destroy {
  void operator()(lacerta_decoder* decoder) const { lacerta_decoder_destroy(decoder); }
};
using Decoder = std::unique_ptr<lacerta_decoder, Destroy>;

inline Decoder Create(const lacerta_decoder_options* options = nullptr) {
  lacerta_decoder* decoder = nullptr;
  EXPECT_EQ(lacerta_decoder_create(options, &decoder), LACERTA_OK);
  return Decoder(decoder);
}

inline Decoder Create(const lacerta_decoder_options& options) { return Create(&options); }

inline std::string Message(const Decoder& decoder) {
  std::string text(lacerta_decoder_message(decoder.get(), nullptr, 0), '\0');
  lacerta_decoder_message(decoder.get(), text.data(), text.size() + 1);
  return text;
}

inline lacerta_progress Progress(const Decoder& decoder) {
  lacerta_progress progress = LACERTA_PROGRESS_INIT;
  EXPECT_EQ(lacerta_decoder_get_progress(decoder.get(), &progress), LACERTA_OK);
  return progress;
}

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_PLUGIN_C_DECODER_HANDLE_H_
