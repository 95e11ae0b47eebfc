# SPDX-License-Identifier: MIT
# What a room is, for the two projects that are built from rooms: the program, and the Python package (apps/python).
get_filename_component(CORRAL_ROOT ${CMAKE_CURRENT_LIST_DIR}/.. ABSOLUTE)
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CORRAL_SANITIZE "" CACHE STRING "instrument everything with these sanitizers, such as address,undefined")
option(CORRAL_FUZZ "build the fuzzers of tests/fuzz (needs clang)" OFF)

# The compile options of all our targets; flags of libraries are not among them.
add_library(corral_options INTERFACE)
target_compile_options(corral_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Werror -Wno-psabi
  -ffp-contract=off -fno-math-errno)
# Vector code is compiled for AVX3 (AVX-512), AVX2 and SSE4, or for NEON, and once without; Highway chooses at run time. Its
# other targets bring nothing for floats and doubles.
set(unused "HWY_SSSE3|HWY_AVX3_DL|HWY_SVE|HWY_SVE2|HWY_SVE_256|HWY_SVE2_128")
if(CORRAL_FUZZ)  # one with vectors and the plain one
  string(APPEND unused "|HWY_AVX3|HWY_SSE4")
endif()
target_compile_definitions(corral_options INTERFACE "HWY_DISABLED_TARGETS=(${unused})")
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "aarch64")
  # Highway compiles its NEON code for the cryptographic extension; g++ gives implicit constructors the options of the command
  # line alone. Nothing uses such instructions, and a processor without them takes the plain code.
  target_compile_options(corral_options INTERFACE -march=armv8-a+crypto)
endif()
if(CORRAL_SANITIZE)
  # With the sanitizers g++ 12 gives false warnings of uninitialised members in the standard library.
  target_compile_options(corral_options INTERFACE -fsanitize=${CORRAL_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(corral_options INTERFACE -Wno-maybe-uninitialized)
  else()  # clang takes ten minutes for a file of vector code with these; the address sanitizer sees most of what they see
    target_compile_options(corral_options INTERFACE -fno-sanitize=null,alignment,object-size,vptr,pointer-overflow)
  endif()
  target_link_options(corral_options INTERFACE -fsanitize=${CORRAL_SANITIZE})
endif()
if(CORRAL_FUZZ)
  target_compile_options(corral_options INTERFACE -fsanitize=fuzzer-no-link)
endif()

include(GNUInstallDirs)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(hwy 1.0.3 REQUIRED CONFIG)

# One static library per room: corral_room(<name> <folder>...) is corral_<name>, and corral::<name> to others. Its sources are all
# that are in these folders.
function(corral_room name)
  list(TRANSFORM ARGN APPEND /*.cpp OUTPUT_VARIABLE patterns)
  file(GLOB sources CONFIGURE_DEPENDS ${patterns})
  add_library(corral_${name} STATIC ${sources})
  add_library(corral::${name} ALIAS corral_${name})
  set_target_properties(corral_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(corral_${name} PUBLIC
    $<BUILD_INTERFACE:${CORRAL_ROOT}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/corral>)
  target_link_libraries(corral_${name} PRIVATE $<BUILD_INTERFACE:corral_options>)
endfunction()
