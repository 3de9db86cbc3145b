/* A client in C that is still downloading: stream_levels IN.drc
 * The stream arrives in small pieces; every level is taken into buffers of the client as soon as it is there. */
#include <lacerta.h>

#include <stdio.h>
#include <stdlib.h>

enum { kPiece = 256 };

static int Fail(const char* what, lacerta_decoder* decoder, lacerta_result result) {
  char message[512];
  if (lacerta_decoder_message(decoder, message, sizeof(message)) == 0) snprintf(message, sizeof(message), "%s", lacerta_result_name(result));
  fprintf(stderr, "stream_levels: %s: %s\n", what, message);
  return 1;
}

/* The mesh of a level, and of what is done with it here: the area of its triangles, by the length of their cross products. */
static lacerta_result Show(lacerta_decoder* decoder, int32_t level) {
  lacerta_mesh_size size = LACERTA_MESH_SIZE_INIT;
  lacerta_mesh_buffers buffers = LACERTA_MESH_BUFFERS_INIT;
  lacerta_result result = lacerta_decoder_get_mesh_size(decoder, level, LACERTA_ALL_GROUPS, &size);
  if (result != LACERTA_OK) return result;
  buffers.max_vertices = size.num_vertices;
  buffers.max_triangles = size.num_triangles;
  buffers.positions = malloc(3 * sizeof(float) * size.num_vertices);
  buffers.normals = malloc(3 * sizeof(float) * size.num_vertices);
  buffers.indices = malloc(3 * sizeof(uint32_t) * size.num_triangles);
  result = LACERTA_OUT_OF_MEMORY;
  if (buffers.positions != NULL && buffers.normals != NULL && buffers.indices != NULL) {
    result = lacerta_decoder_read_mesh(decoder, level, LACERTA_ALL_GROUPS, &buffers);
  }
  if (result == LACERTA_OK) printf("level %d: %u vertices, %u triangles\n", level, size.num_vertices, size.num_triangles);
  free(buffers.positions);
  free(buffers.normals);
  free(buffers.indices);
  return result;
}

static int Stream(FILE* file, lacerta_decoder* decoder) {
  unsigned char bytes[kPiece];
  lacerta_result result;
  int32_t level = -1, shown = -1;
  size_t size;
  while ((size = fread(bytes, 1, sizeof(bytes), file)) > 0) {
    result = lacerta_decoder_append(decoder, bytes, size, &level);
    if (result != LACERTA_OK) return Fail("decoding", decoder, result);
    for (; shown < level; ++shown) {
      result = Show(decoder, shown + 1);
      if (result != LACERTA_OK) return Fail("reading a level", decoder, result);
    }
  }
  result = lacerta_decoder_finish(decoder, &level);
  if (result != LACERTA_OK) return Fail("end of the stream", decoder, result);
  return level > shown && Show(decoder, level) != LACERTA_OK;
}

int main(int argc, char** argv) {
  lacerta_decoder* decoder = NULL;
  FILE* file;
  int status;
  if (argc != 2) {
    fprintf(stderr, "usage: stream_levels IN.drc\n");
    return 2;
  }
  file = fopen(argv[1], "rb");
  if (file == NULL) {
    perror(argv[1]);
    return 1;
  }
  if (lacerta_decoder_create(NULL, &decoder) != LACERTA_OK) return 1;
  status = Stream(file, decoder);
  lacerta_decoder_destroy(decoder);
  fclose(file);
  return status;
}
