# Writes OUT, a C++ file that holds Foxglove's JSON schemas, those of npm's @foxglove/schemas 2.1.0 (MIT
# licence, beside this file), as a table of name and text. Run as a script: -DHERE=<this folder>
# -DOUT=<file>.
set(schemas_sha256 acc25fb4383ab056bd239829cfa48882818cabe0298beeafb00a1284e7ae8418)

set(all "")
set(text "#include \"foxglove_schemas.hpp\"\n\nnamespace vigia::report::foxglove {\n\nconst std::array<McapSchema, 9> kSchemas{{\n")
foreach(name CameraCalibration CompressedImage FrameTransforms ImageAnnotations Log Odometry PoseInFrame
             PosesInFrame SceneUpdate)
  file(READ ${HERE}/${name}.json content)
  string(APPEND all "${content}")
  string(APPEND text "    {\"foxglove.${name}\", R\"schema(${content})schema\"},\n")
endforeach()
string(SHA256 found "${all}")
if(NOT found STREQUAL schemas_sha256)
  message(FATAL_ERROR "${HERE}: the schemas have the SHA-256 ${found}, must have ${schemas_sha256}")
endif()
file(WRITE ${OUT} "${text}}};\n\n}  // namespace vigia::report::foxglove\n")
