// tinygltf as a host compiles it: in a translation unit of its own.
#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
