/// tinygltf itself, as Debian builds it for other machines. It decodes no images: they stay as they are in the file.
#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
