/* The installed library and its one header, from C. */
#include <lacerta.h>

#include <string.h>

int main(void) {
  lacerta_decoder* decoder = NULL;
  lacerta_progress progress = LACERTA_PROGRESS_INIT;
  char message[256];
  if (lacerta_version() >> 16 != LACERTA_VERSION_MAJOR) return 1;
  if (lacerta_decode_prefix("no stream", 9, NULL, &decoder) != LACERTA_INVALID_DATA || decoder != NULL) return 2;
  if (lacerta_decoder_create(NULL, &decoder) != LACERTA_OK) return 3;
  if (lacerta_decoder_append(decoder, "no stream", 9, NULL) != LACERTA_INVALID_DATA) return 4;
  if (lacerta_decoder_message(decoder, message, sizeof(message)) == 0 || strstr(message, "DRACO") == NULL) return 5;
  if (lacerta_decoder_get_progress(decoder, &progress) != LACERTA_OK || progress.level != -1) return 6;
  lacerta_decoder_destroy(decoder);
  return 0;
}
