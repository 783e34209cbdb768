// The descriptors of the protos as they are now, and as they were agreed on last.

#ifndef RICOCHET_TESTS_PROTO_API_FILES_H_
#define RICOCHET_TESTS_PROTO_API_FILES_H_

#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>
#include <gtest/gtest.h>

#include <vector>

#include "proto/comments/commented_protos.h"

namespace ricochet {

// The files of package ricochet.v1 with their comments, as the build collects them.
inline google::protobuf::FileDescriptorSet ProtosWithComments() {
  google::protobuf::FileDescriptorSet files;
  EXPECT_TRUE(files.ParseFromArray(kCommentedProtos.data(), static_cast<int>(kCommentedProtos.size())));
  return files;
}

// Adds the files to a pool, which must outlive what is returned.
inline std::vector<const google::protobuf::FileDescriptor*> Build(const google::protobuf::FileDescriptorSet& files,
                                                                  google::protobuf::DescriptorPool& pool) {
  std::vector<const google::protobuf::FileDescriptor*> built;
  for (const google::protobuf::FileDescriptorProto& file : files.file()) {
    built.push_back(pool.BuildFile(file));
    EXPECT_NE(built.back(), nullptr) << file.name();
  }
  return built;
}

}  // namespace ricochet

#endif  // RICOCHET_TESTS_PROTO_API_FILES_H_
