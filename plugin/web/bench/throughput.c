/* Milliseconds of CPU time that it takes to decode a stream to positions and indices, the best of several: throughput FILE RUNS */
#include <lacerta.h>

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static int Decode(const void* bytes, size_t size) {
  lacerta_decoder* decoder = NULL;
  lacerta_progress progress = LACERTA_PROGRESS_INIT;
  lacerta_mesh_size mesh = LACERTA_MESH_SIZE_INIT;
  lacerta_mesh_buffers buffers = LACERTA_MESH_BUFFERS_INIT;
  int failed = lacerta_decode_prefix(bytes, size, NULL, &decoder) != LACERTA_OK ||
               lacerta_decoder_get_progress(decoder, &progress) != LACERTA_OK ||
               lacerta_decoder_get_mesh_size(decoder, progress.level, LACERTA_ALL_GROUPS, &mesh) != LACERTA_OK;
  buffers.max_vertices = mesh.num_vertices;
  buffers.max_triangles = mesh.num_triangles;
  buffers.positions = malloc(12 * (size_t)mesh.num_vertices);
  buffers.indices = malloc(12 * (size_t)mesh.num_triangles);
  failed = failed || lacerta_decoder_read_mesh(decoder, progress.level, LACERTA_ALL_GROUPS, &buffers) != LACERTA_OK;
  free(buffers.positions);
  free(buffers.indices);
  lacerta_decoder_destroy(decoder);
  return failed;
}

int main(int argc, char** argv) {
  static unsigned char bytes[1 << 24];
  FILE* file = argc == 3 ? fopen(argv[1], "rb") : NULL;
  const size_t size = file != NULL ? fread(bytes, 1, sizeof(bytes), file) : 0;
  double best = 1e9;
  int run;
  for (run = 0; size > 0 && run < atoi(argv[2]); ++run) {
    const clock_t start = clock();
    if (Decode(bytes, size)) return 1;
    const double milliseconds = 1000.0 * (double)(clock() - start) / CLOCKS_PER_SEC;
    if (milliseconds < best) best = milliseconds;
  }
  printf("%.3f\n", best);
  return size == 0;
}
