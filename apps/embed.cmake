# SPDX-License-Identifier: MIT
# Files of the source tree that the program carries with it:
#   corral_embed(<target> <name> <files>...)
# adds the function `const EmbeddedFiles& embedded_<name>()` of apps/runtime/embedded_files.h to the target: the text of each file by its
# name without folders. A changed file is embedded anew. Files are text; run as a script, this writes the source.
if(NOT CMAKE_SCRIPT_MODE_FILE)
  function(corral_embed target name)
    set(script ${CMAKE_CURRENT_FUNCTION_LIST_FILE})
    set(files ${ARGN})
    get_filename_component(root ${CMAKE_CURRENT_FUNCTION_LIST_DIR} DIRECTORY)
    list(TRANSFORM files PREPEND ${root}/)
    set(source ${CMAKE_CURRENT_BINARY_DIR}/embedded_${name}.cpp)
    add_custom_command(OUTPUT ${source} DEPENDS ${files} ${script} VERBATIM
      COMMAND ${CMAKE_COMMAND} -D NAME=${name} -D SOURCE=${source} -D "FILES=${files}" -P ${script})
    target_sources(${target} PRIVATE ${source})
  endfunction()
  return()
endif()

set(entries "")
foreach(file IN LISTS FILES)
  file(READ ${file} text)
  if(text MATCHES "\\)embedded\"")
    message(FATAL_ERROR "${file}: the text )embedded\" ends what is embedded")
  endif()
  get_filename_component(name ${file} NAME)
  string(APPEND entries "    {\"${name}\", R\"embedded(${text})embedded\"},\n")
endforeach()
file(WRITE ${SOURCE} "#include \"apps/runtime/embedded_files.h\"

namespace corral {

const EmbeddedFiles& embedded_${NAME}();
const EmbeddedFiles& embedded_${NAME}() {
  static const EmbeddedFiles files = {
${entries}  };
  return files;
}

}  // namespace corral
")
