// The decoder by itself refuses what is no stream.
#include <lacerta/decoder.h>

int main() {
  const lacerta::Bytes bytes(16, 0);
  return lacerta::ReadRefinementInfo(bytes).ok() ? 1 : 0;
}
