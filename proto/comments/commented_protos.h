// CommentedProtos: the protos of the service with their comments, which generated code leaves out.

#ifndef RICOCHET_PROTO_COMMENTS_COMMENTED_PROTOS_H_
#define RICOCHET_PROTO_COMMENTS_COMMENTED_PROTOS_H_

#include <google/protobuf/descriptor.h>

#include <string>

#include "absl/strings/string_view.h"

namespace ricochet {

// A serialized google.protobuf.FileDescriptorSet with source info, which the build collects.
extern const absl::string_view kCommentedProtos;

// Returns the files of package ricochet.v1. It is built at the first call, and lives as long as the program.
const google::protobuf::DescriptorPool& CommentedProtos();

// Joins the lines of a comment.
std::string OnOneLine(const std::string& comment);

// Returns the comment above a message, field, oneof, enum or enum value of CommentedProtos(), on one line.
template <typename Element>
std::string CommentOf(const Element& element) {
  google::protobuf::SourceLocation location;
  return element.GetSourceLocation(&location) ? OnOneLine(location.leading_comments) : "";
}

}  // namespace ricochet

#endif  // RICOCHET_PROTO_COMMENTS_COMMENTED_PROTOS_H_
