/* Progressive decoding of Lacerta streams, for programs in C and everything that calls C.
 *
 *   lacerta_decoder* decoder = NULL;
 *   lacerta_decoder_create(NULL, &decoder);
 *   while ((size = receive(bytes)) > 0) {
 *     int32_t level;
 *     if (lacerta_decoder_append(decoder, bytes, size, &level) != LACERTA_OK) break;   // what is there stays
 *     if (level > shown) draw(decoder, shown = level);
 *   }
 *   lacerta_decoder_destroy(decoder);
 *
 * No function throws or ends the process; all of them are safe on untrusted bytes. A decoder may be used by any thread, by
 * several at a time too: its calls wait for one another. Different decoders share nothing. Structs begin with their own size, so that
 * programs built with an older header go on working; initialize them with the macros beside them. */
#ifndef LACERTA_H_
#define LACERTA_H_

#include <stddef.h>
#include <stdint.h>

#define LACERTA_VERSION_MAJOR 0
#define LACERTA_VERSION_MINOR 1
#define LACERTA_VERSION_PATCH 0

#if defined(_WIN32)
#if defined(LACERTA_C_BUILD)
#define LACERTA_API __declspec(dllexport)
#else
#define LACERTA_API __declspec(dllimport)
#endif
#elif defined(__GNUC__)
#define LACERTA_API __attribute__((visibility("default")))
#else
#define LACERTA_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* What came of a call. */
typedef int32_t lacerta_result;
enum {
  LACERTA_OK = 0,
  LACERTA_INVALID_ARGUMENT = 1, /* a value that the caller passed */
  LACERTA_INVALID_DATA = 2,     /* damaged or truncated bytes, or a base that the refinement was not made for */
  LACERTA_UNSUPPORTED = 3,      /* legal, but not read by this version */
  LACERTA_LIMIT_EXCEEDED = 4,   /* over max_vertices or max_triangles */
  LACERTA_OUT_OF_MEMORY = 5,
  LACERTA_INTERNAL = 6,
  LACERTA_NEEDS_BASE = 7        /* the base is a Draco stream and this library has no Draco: see lacerta_decoder_set_base */
};

/* (major << 16) | (minor << 8) | patch of the library at hand; LACERTA_VERSION_... are those of this header. */
LACERTA_API uint32_t lacerta_version(void);
/* 1 where the library decodes bases in Draco form by itself, else 0. */
LACERTA_API int32_t lacerta_has_draco(void);
/* The result in a word or two, in English; a string that always stays. */
LACERTA_API const char* lacerta_result_name(lacerta_result result);

/* Where the memory of the handle and of bytes that wait comes from. What is decoded goes into the caller's buffers; the tables that
 * decoding needs, within max_vertices and max_triangles, come from operator new. Both functions must be callable from every thread that uses the decoder. */
typedef struct lacerta_allocator {
  void* (*allocate)(void* user, size_t size);                  /* aligned as by malloc; NULL where there is none */
  void (*deallocate)(void* user, void* memory, size_t size);
  void* user;
} lacerta_allocator;

typedef struct lacerta_decoder_options {
  uint32_t struct_size;
  int32_t max_level;      /* no level above it is decoded; negative: all of them */
  uint64_t max_vertices;  /* of the finest level; 0: 64 Mi. A level over the limits is not decoded. */
  uint64_t max_triangles; /* 0: 128 Mi */
  /* How many of the bytes to come are the base section, where the caller knows it: glTF tells it. With 0 the library finds out,
   * which takes longer for Draco bases that arrive in small pieces. */
  uint64_t base_size;
  const lacerta_allocator* allocator; /* NULL: malloc and free. Copied; only its `user` has to live on. */
  /* Of a stream with attributes and groups, which only glTF tells ("baseLengths" and "attributes" of
   * LACERTA_mesh_progressive): the bytes of each group's Draco stream, which together are the base section, and the
   * names of the attributes, at most 32. Copied. NULL and 0 else. Of a skinned surface ("joints" there) WEIGHTS_0 has a
   * component for each joint, here as in what is read; hosts make those of the base's JOINTS_0 and WEIGHTS_0 and set
   * the groups themselves (lacerta_decoder_set_base_group), even where the library has Draco. Morph targets are
   * attributes with three components for each of them (TARGETS_0_POSITION and the like), in bases and in what is read.
   */
  const uint64_t* base_lengths;
  uint32_t num_groups;
  uint32_t num_attributes;
  const char* const* attribute_names;
} lacerta_decoder_options;
#define LACERTA_DECODER_OPTIONS_INIT {sizeof(lacerta_decoder_options), -1, 0, 0, 0, NULL, NULL, 0, 0, NULL}

typedef struct lacerta_decoder lacerta_decoder;

/* Makes a decoder of one stream. options: NULL for the defaults. Fails with LACERTA_INVALID_ARGUMENT and LACERTA_OUT_OF_MEMORY. */
LACERTA_API lacerta_result lacerta_decoder_create(const lacerta_decoder_options* options, lacerta_decoder** decoder);
/* NULL is allowed. */
LACERTA_API void lacerta_decoder_destroy(lacerta_decoder* decoder);

/* Takes the next bytes of the stream, however they are cut, and decodes every level that they complete.
 *   level  out, may be NULL: the finest complete level, 0 being the base; -1 while the base is not complete
 * After a failure the levels so far stay, the same failure is returned again and further bytes are ignored. LACERTA_NEEDS_BASE is no
 * failure: the bytes are kept until the base is set. Bytes after the end of the stream are ignored. */
LACERTA_API lacerta_result lacerta_decoder_append(lacerta_decoder* decoder, const void* bytes, size_t size, int32_t* level);

/* Says that no more bytes will come. Fails with LACERTA_INVALID_DATA where even the base is incomplete; refinement that just ends early
 * is no failure. */
LACERTA_API lacerta_result lacerta_decoder_finish(lacerta_decoder* decoder, int32_t* level);

/* Sets the base mesh that the host's own Draco decoder, or glTF loader, made of the base section: vertices and triangles in that
 * decoder's order.
 *   positions  num_vertices x 3, model units;  indices  num_triangles x 3, < num_vertices
 * To be called before the first byte is appended or after LACERTA_NEEDS_BASE. base_size bytes of the stream are skipped then; where
 * base_size is 0 the library looks for the refinement that fits, at the front of the stream or behind the base section. Refused with LACERTA_INVALID_ARGUMENT where there is a base already. */
LACERTA_API lacerta_result lacerta_decoder_set_base(lacerta_decoder* decoder, const float* positions, uint32_t num_vertices,
                                                    const uint32_t* indices, uint32_t num_triangles);

/* The same for a stream with attributes: the base of one group, as the host made it of that group's Draco stream. To be called once for each group. */
typedef struct lacerta_base_group {
  uint32_t struct_size;
  uint32_t num_vertices;
  uint32_t num_triangles;
  uint32_t num_attributes;        /* entries of the following arrays */
  const float* positions;         /* num_vertices x 3, model units */
  const uint32_t* indices;        /* num_triangles x 3, < num_vertices */
  const float* const* attributes; /* entry i: num_vertices x components[i] of attribute i, or NULL: the group has not got it */
  const uint32_t* components;
} lacerta_base_group;
#define LACERTA_BASE_GROUP_INIT {sizeof(lacerta_base_group), 0, 0, 0, NULL, NULL, NULL, NULL}
LACERTA_API lacerta_result lacerta_decoder_set_base_group(lacerta_decoder* decoder, uint32_t group, const lacerta_base_group* base);

/* The base section for the host's Draco decoder: after LACERTA_NEEDS_BASE, complete where base_size was given or the stream is in custom
 * form; else as much as has come (Draco ignores what follows it). The bytes are valid until the next call with this decoder. */
LACERTA_API lacerta_result lacerta_decoder_base_section(lacerta_decoder* decoder, const uint8_t** bytes, size_t* size);

/* How far a decoder is. */
typedef struct lacerta_progress {
  uint32_t struct_size;
  int32_t level;      /* the finest complete one; -1: no base yet */
  int32_t num_levels; /* above the base, that the stream announces; -1: not known yet */
  /* Meshes above the base that the bytes so far make. Equal to `level`, but for streams with quality layers, where a later state may have the
   * same level as the one before and be nearer to the surface. */
  int32_t state;
  int32_t has_layers;  /* 1: the stream has quality layers */
  int32_t is_complete; /* 1: nothing that is wanted is missing */
  uint64_t bytes_used; /* length of the prefix that holds what is there */
  uint32_t num_groups; /* of faces, one per material; at least 1 once there is a base */
  uint32_t num_attributes; /* besides position */
} lacerta_progress;
#define LACERTA_PROGRESS_INIT {sizeof(lacerta_progress), 0, 0, 0, 0, 0, 0, 0, 0}
LACERTA_API lacerta_result lacerta_decoder_get_progress(lacerta_decoder* decoder, lacerta_progress* progress);

/* Copies the message of the last call that did not end with LACERTA_OK, cut to size - 1 characters and ended by a zero; "" where all went
 * well. Returns its whole length. */
LACERTA_API size_t lacerta_decoder_message(lacerta_decoder* decoder, char* text, size_t size);

typedef struct lacerta_attribute {
  uint32_t struct_size;
  uint32_t components;  /* floats per vertex; 0 while there is no base, or where no group has it */
  char name[64];        /* as in glTF: "TEXCOORD_0", ...; ended by a zero */
} lacerta_attribute;
#define LACERTA_ATTRIBUTE_INIT {sizeof(lacerta_attribute), 0, {0}}
/* index: below num_attributes of lacerta_progress, in the order of the options. */
LACERTA_API lacerta_result lacerta_decoder_get_attribute(lacerta_decoder* decoder, uint32_t index, lacerta_attribute* attribute);

/* The mesh of one group of faces, or of all of them as one, at one level. A vertex has one value of each attribute: the surface is cut along seams, and
 * between groups, where vertices have the same positions bit by bit on every level. */
#define LACERTA_ALL_GROUPS UINT32_MAX
typedef struct lacerta_mesh_size {
  uint32_t struct_size;
  uint32_t num_vertices;
  uint32_t num_triangles;
  uint32_t attributes; /* bit i: the group, or one of all, has got attribute i */
} lacerta_mesh_size;
#define LACERTA_MESH_SIZE_INIT {sizeof(lacerta_mesh_size), 0, 0, 0}
/* level: 0 to the finest complete one; asking for the latter is the quickest. */
LACERTA_API lacerta_result lacerta_decoder_get_mesh_size(lacerta_decoder* decoder, int32_t level, uint32_t group,
                                                         lacerta_mesh_size* mesh_size);

/* Where a mesh is to be written. Each pointer may be NULL: not wanted. */
typedef struct lacerta_mesh_buffers {
  uint32_t struct_size;
  uint32_t max_vertices;  /* that the buffers have room for */
  uint32_t max_triangles;
  uint32_t num_attributes; /* entries of `attributes` */
  float* positions;        /* num_vertices x 3, model units */
  float* normals;          /* num_vertices x 3, of length 1: smooth, weighted by corner angles, whole surface considered */
  uint32_t* indices;       /* num_triangles x 3, < num_vertices, counterclockwise seen from outside */
  float* const* attributes; /* entry i: num_vertices x components of attribute i, or NULL; 0 where a group has not got it */
} lacerta_mesh_buffers;
#define LACERTA_MESH_BUFFERS_INIT {sizeof(lacerta_mesh_buffers), 0, 0, 0, NULL, NULL, NULL, NULL}
/* Writes the mesh whose size lacerta_decoder_get_mesh_size tells. Fails with LACERTA_INVALID_ARGUMENT, and writes nothing, where the
 * buffers are too small or the level or group is not there. */
LACERTA_API lacerta_result lacerta_decoder_read_mesh(lacerta_decoder* decoder, int32_t level, uint32_t group,
                                                     const lacerta_mesh_buffers* buffers);

/* Random access: a decoder of the levels that one prefix of a stream holds, up to options->max_level. As create, append and finish. The
 * decoder comes, and has to be destroyed, where only refinement is at fault, too; it is NULL where there is not even a base. */
LACERTA_API lacerta_result lacerta_decode_prefix(const void* bytes, size_t size, const lacerta_decoder_options* options,
                                                 lacerta_decoder** decoder);

#ifdef __cplusplus
}
#endif

#endif /* LACERTA_H_ */
