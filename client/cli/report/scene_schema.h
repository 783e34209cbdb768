// The JSON Schema of a scene, made of the protos and their comments.

#ifndef RICOCHET_CLIENT_CLI_REPORT_SCENE_SCHEMA_H_
#define RICOCHET_CLIENT_CLI_REPORT_SCENE_SCHEMA_H_

#include <string>

namespace ricochet::cli {

// Returns a schema of draft 2020-12 for ricochet.v1.Scene with the names of the proto: types, units, ranges of single
// numbers, lengths of lists, required fields and exclusive ones. Rules that tie one number to another are not in it.
std::string SceneSchema();

// Returns the schema of a ricochet.v1.MultiContactScene.
std::string MultiContactSceneSchema();

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_REPORT_SCENE_SCHEMA_H_
