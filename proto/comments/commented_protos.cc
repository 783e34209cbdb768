#include "proto/comments/commented_protos.h"

#include <google/protobuf/descriptor.pb.h>

#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"

namespace ricochet {

const google::protobuf::DescriptorPool& CommentedProtos() {
  static const auto* const pool = [] {
    auto* made = new google::protobuf::DescriptorPool();
    google::protobuf::FileDescriptorSet files;
    files.ParseFromArray(kCommentedProtos.data(), static_cast<int>(kCommentedProtos.size()));
    for (const google::protobuf::FileDescriptorProto& file : files.file()) made->BuildFile(file);
    return made;
  }();
  return *pool;
}

std::string OnOneLine(const std::string& comment) {
  return absl::StrJoin(absl::StrSplit(comment, absl::ByAnyChar(" \n"), absl::SkipEmpty()), " ");
}

}  // namespace ricochet
