# SPDX-License-Identifier: MIT
# The target `docs`: API pages from the headers and the README of each room, in build/<preset>/docs/html. A warning is an error.
find_package(Doxygen QUIET OPTIONAL_COMPONENTS dot)
if(DOXYGEN_FOUND)
  set(DOXYGEN_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/docs)
  set(DOXYGEN_FILE_PATTERNS *.h)
  set(DOXYGEN_INPUT_FILTER "awk -f ${PROJECT_SOURCE_DIR}/.github/cards.awk")
  set(DOXYGEN_IMAGE_PATH ${PROJECT_SOURCE_DIR}/.github)
  set(DOXYGEN_USE_MDFILE_AS_MAINPAGE ${PROJECT_SOURCE_DIR}/README.md)
  set(DOXYGEN_EXTRACT_ALL YES)
  set(DOXYGEN_GENERATE_TREEVIEW YES)
  set(DOXYGEN_SHOW_INCLUDE_FILES NO)
  set(DOXYGEN_VERBATIM_HEADERS NO)
  set(DOXYGEN_HTML_TIMESTAMP NO)
  set(DOXYGEN_QUIET YES)
  set(DOXYGEN_WARN_AS_ERROR FAIL_ON_WARNINGS)
  foreach(graph CLASS_GRAPH COLLABORATION_GRAPH INCLUDE_GRAPH INCLUDED_BY_GRAPH GROUP_GRAPHS GRAPHICAL_HIERARCHY)
    set(DOXYGEN_${graph} NO)
  endforeach()
  doxygen_add_docs(docs kernel grouping refine io apps README.md .github/CONTRIBUTING.md .github/CHANGELOG.md kernel/README.md
    kernel/surface/README.md grouping/README.md refine/README.md io/README.md apps/README.md tests/README.md data/README.md
    paper/README.md WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
endif()
