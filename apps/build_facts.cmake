# SPDX-License-Identifier: MIT
# What the manifest of a run says of the program: corral_build_facts(<target>) gives the target the header build_facts.h. It is
# looked at in every build and written only if something changed (the commit, mostly), so that nothing else is built anew.
if(NOT CMAKE_SCRIPT_MODE_FILE)
  set(CORRAL_BUILD_FACTS_SCRIPT ${CMAKE_CURRENT_LIST_FILE})
  function(corral_library_version result name directory variable)
    get_directory_property(version DIRECTORY ${PROJECT_SOURCE_DIR}/${directory} DEFINITION ${variable})
    if(version)
      set(${result} "${${result}}${name}=${version};" PARENT_SCOPE)
    endif()
  endfunction()
  function(corral_build_facts target)
    set(libraries "")
    corral_library_version(libraries Eigen . Eigen3_VERSION)
    corral_library_version(libraries CGAL kernel/surface CGAL_VERSION)
    corral_library_version(libraries OpenMesh kernel/surface OpenMesh_VERSION)
    corral_library_version(libraries FLANN kernel/surface flann_VERSION)
    corral_library_version(libraries Ceres refine Ceres_VERSION)
    corral_library_version(libraries CLI11 apps CLI11_VERSION)
    corral_library_version(libraries nlohmann-json apps nlohmann_json_VERSION)
    corral_library_version(libraries oneTBB apps TBB_VERSION)
    string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
    get_target_property(options corral_options INTERFACE_COMPILE_OPTIONS)
    string(JOIN " " flags ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${type}} ${options})
    set(folder ${CMAKE_CURRENT_BINARY_DIR}/facts)
    add_custom_target(${target}_facts BYPRODUCTS ${folder}/apps/runtime/build_facts.h VERBATIM
      COMMAND ${CMAKE_COMMAND} -D ROOT=${PROJECT_SOURCE_DIR} -D HEADER=${folder}/apps/runtime/build_facts.h -D VERSION=${PROJECT_VERSION}
        -D "COMPILER=${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}" -D "FLAGS=${flags}" -D "LIBRARIES=${libraries}"
        -P ${CORRAL_BUILD_FACTS_SCRIPT})
    add_dependencies(${target} ${target}_facts)
    target_include_directories(${target} PRIVATE $<BUILD_INTERFACE:${folder}>)
  endfunction()
  return()
endif()

set(commit unknown)
if(EXISTS ${ROOT}/.git)
  execute_process(COMMAND git -C ${ROOT} describe --always --abbrev=40 --dirty --exclude=* OUTPUT_VARIABLE said
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(NOT failed)
    set(commit ${said})
  endif()
endif()
file(CONFIGURE OUTPUT ${HEADER} @ONLY CONTENT [[// SPDX-License-Identifier: MIT
#pragma once
#define CORRAL_VERSION "@VERSION@"
#define CORRAL_COMMIT "@commit@"
#define CORRAL_COMPILER "@COMPILER@"
#define CORRAL_FLAGS "@FLAGS@"
#define CORRAL_LIBRARIES "@LIBRARIES@"
]])
