// Whether what a document refers to by index is there.
#ifndef LACERTA_DOCUMENT_REFERENCES_H_
#define LACERTA_DOCUMENT_REFERENCES_H_

#include <string>
#include <vector>

#include "document/json.h"
#include "lacerta/status.h"

namespace lacerta {

// The indices of a document beyond the end of what they index, each as a message with its JSON pointer: all that the core format has (glTF 2.0,
// section 5), and those of extensions for textures, materials, lights, instances and Draco. What is no index at all is left to whoever reads it.
std::vector<std::string> DanglingReferences(const Json& json);

// Fails with kInvalidData at the first of them.
Status CheckReferences(const Json& json);

}  // namespace lacerta

#endif  // LACERTA_DOCUMENT_REFERENCES_H_
