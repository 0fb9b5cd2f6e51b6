# The functions chapters and tests are declared with.

# welkin_shaders(TARGET DIRECTORY [OUTPUT]): compiles every shader of shaders/DIRECTORY to
# ${CMAKE_BINARY_DIR}/shaders/OUTPUT (DIRECTORY if not given).
# Dependency files make an edited include rebuild exactly the shaders that use it.
# SPIR-V of Vulkan 1.2: from 1.3 on the compiler writes LocalSizeId, which needs a feature nothing else here does.
function(welkin_shaders target directory)
  set(output_directory ${CMAKE_BINARY_DIR}/shaders/${directory})
  if(ARGC GREATER 2)
    set(output_directory ${CMAKE_BINARY_DIR}/shaders/${ARGV2})
  endif()
  file(MAKE_DIRECTORY ${output_directory})
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/shaders/${directory}/*.comp
       ${PROJECT_SOURCE_DIR}/shaders/${directory}/*.vert ${PROJECT_SOURCE_DIR}/shaders/${directory}/*.frag)
  set(outputs)
  foreach(source IN LISTS sources)
    get_filename_component(name ${source} NAME)
    set(output ${output_directory}/${name}.spv)
    add_custom_command(
      OUTPUT ${output}
      COMMAND ${GLSLANG_VALIDATOR} -V --target-env vulkan1.2 --quiet -I${PROJECT_SOURCE_DIR}/shaders
              --depfile ${output}.d -o ${output} ${source}
      DEPENDS ${source}
      DEPFILE ${output}.d
      COMMENT "shader ${directory}/${name}"
      VERBATIM)
    list(APPEND outputs ${output})
  endforeach()
  add_custom_target(${target} ALL DEPENDS ${outputs})
endfunction()

# welkin_chapter(NUMBER 05 NAME single_scattering USES planet_and_rays air): the program chapters/05_single_scattering.
# Only the headers of the chapters it USES (and theirs) can be included; a chapter may use lower numbers only.
# Every .cpp beside main.cpp goes into the library chapter_NAME, which later chapters and tests link.
function(welkin_chapter)
  cmake_parse_arguments(PARSE_ARGV 0 chapter "" "NUMBER;NAME" "USES")
  set(full ${chapter_NUMBER}_${chapter_NAME})
  set(directory ${PROJECT_SOURCE_DIR}/chapters/${full})
  set_property(GLOBAL PROPERTY welkin_number_${chapter_NAME} ${chapter_NUMBER})
  set_property(GLOBAL APPEND PROPERTY welkin_chapters ${full})

  # Headers are reached through a directory of links that holds this chapter and nothing else.
  set(include_directory ${CMAKE_BINARY_DIR}/include/${full})
  file(MAKE_DIRECTORY ${include_directory}/chapters)
  file(CREATE_LINK ${directory} ${include_directory}/chapters/${full} SYMBOLIC)

  file(GLOB sources CONFIGURE_DEPENDS ${directory}/*.cpp)
  list(REMOVE_ITEM sources ${directory}/main.cpp)
  if(sources)
    add_library(chapter_${chapter_NAME} STATIC ${sources})
    set(scope PUBLIC)
  else()
    add_library(chapter_${chapter_NAME} INTERFACE)
    set(scope INTERFACE)
  endif()
  target_include_directories(chapter_${chapter_NAME} ${scope} ${include_directory})
  target_link_libraries(chapter_${chapter_NAME} ${scope} welkin_app)
  foreach(used IN LISTS chapter_USES)
    get_property(number GLOBAL PROPERTY welkin_number_${used})
    if(NOT number OR NOT number LESS chapter_NUMBER)
      message(FATAL_ERROR "chapter ${full} uses '${used}': a chapter may use only chapters declared before it, with a lower number")
    endif()
    target_link_libraries(chapter_${chapter_NAME} ${scope} chapter_${used})
  endforeach()

  add_executable(${full} ${directory}/main.cpp)
  target_link_libraries(${full} PRIVATE chapter_${chapter_NAME} welkin_app)
  welkin_shaders(shaders_${full} ${full})
  add_dependencies(${full} shaders_${full} shaders_app)
  add_dependencies(chapter_${chapter_NAME} shaders_${full})  # who links the passes of a chapter needs its shaders
endfunction()
