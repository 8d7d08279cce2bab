# SPDX-License-Identifier: Apache-2.0
# The kernels on NVIDIA cards, in two programs: cei3d_cuda_test, the tests of core/compute with the card among the
# devices, and cei3d_cuda_bench. Nothing else links CUDA. Both run on other Linux machines of the same kind of processor:
# what they need besides the C library is linked statically, but oneTBB, which they look for beside themselves, too.

# cei3d_cu(source object): compiled for cards of capability 9.0, and as PTX for all others from 7.5 on.
function(cei3d_cu source object)
  add_custom_command(OUTPUT ${object} DEPENDS ${source} DEPFILE ${object}.d COMMENT "nvcc ${source}"
    COMMAND ${NVCC} -std=c++20 -O3 -ccbin ${CMAKE_CXX_COMPILER} --expt-relaxed-constexpr -ftz=true
            -gencode arch=compute_90,code=sm_90 -gencode arch=compute_75,code=compute_75
            -I${CMAKE_SOURCE_DIR}/src -MD -MF ${object}.d -c ${source} -o ${object})
  set_source_files_properties(${object} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
endfunction()

function(cei3d_cuda_program program)
  target_compile_options(${program} PRIVATE ${CEI3D_FLAGS})
  target_include_directories(${program} SYSTEM PRIVATE ${CUDA_HEADERS})
  target_link_libraries(${program} PRIVATE cei3d_core_compute_cuda)
  target_link_options(${program} PRIVATE -static-libstdc++ -static-libgcc -Wl,--as-needed)
  set_target_properties(${program} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}
    BUILD_RPATH "$ORIGIN" BUILD_RPATH_USE_ORIGIN ON)
endfunction()

# The CPU devices and the card. fmt is compiled in, because these programs are to need few libraries.
function(cei3d_cuda_library path folder)
  set(own ${CMAKE_SOURCE_DIR}/src/${path})
  set(sources ${own}/device.cpp ${own}/planes.cpp ${folder}/failed.cpp ${CMAKE_BINARY_DIR}/cuda_run.o)
  cei3d_cu(${folder}/run.cu ${CMAKE_BINARY_DIR}/cuda_run.o)
  add_library(cei3d_core_compute_cuda STATIC EXCLUDE_FROM_ALL ${sources})
  get_target_property(isas cei3d_core_compute COMPILE_DEFINITIONS)
  target_compile_definitions(cei3d_core_compute_cuda PRIVATE ${isas} CEI3D_CUDA_DEVICE=1)
  target_compile_options(cei3d_core_compute_cuda PRIVATE ${CEI3D_FLAGS})
  target_include_directories(cei3d_core_compute_cuda PUBLIC ${CMAKE_SOURCE_DIR}/src)
  foreach(isa scalar ${CEI3D_X86_ISAS})
    if(TARGET cei3d_core_compute_${isa})
      target_sources(cei3d_core_compute_cuda PRIVATE $<TARGET_OBJECTS:cei3d_core_compute_${isa}>)
    endif()
  endforeach()
  target_link_libraries(cei3d_core_compute_cuda PUBLIC cei3d_core_math fmt::fmt-header-only ${CUDART} pthread dl rt)
endfunction()

function(cei3d_cuda path)
  find_program(NVCC nvcc HINTS /usr/local/cuda/bin)
  if(NOT CEI3D_CUDA OR NOT NVCC)
    return()
  endif()
  file(REAL_PATH ${NVCC} nvcc)
  get_filename_component(toolkit ${nvcc} DIRECTORY)
  find_library(CUDART cudart_static HINTS ${toolkit}/../lib64 ${toolkit}/../targets/x86_64-linux/lib)
  find_path(CUDA_HEADERS cuda_runtime.h HINTS ${toolkit}/../include ${toolkit}/../targets/x86_64-linux/include)
  if(NOT CUDART OR NOT CUDA_HEADERS)
    message(WARNING "The kernels are not built for cards: there is nvcc, but no libcudart_static.a or cuda_runtime.h")
    return()
  endif()
  set(folder ${CMAKE_SOURCE_DIR}/src/${path}/cuda)
  cei3d_cuda_library(${path} ${folder})

  cei3d_cu(${folder}/bench.cu ${CMAKE_BINARY_DIR}/cuda_bench.o)
  set(threads ${CMAKE_SOURCE_DIR}/src/core/base/parallel.cpp ${CMAKE_SOURCE_DIR}/src/core/base/parallel_for.cpp)
  add_executable(cei3d_cuda_bench EXCLUDE_FROM_ALL ${CMAKE_BINARY_DIR}/cuda_bench.o ${folder}/bench_report.cpp ${threads})
  cei3d_cuda_program(cei3d_cuda_bench)
  target_link_libraries(cei3d_cuda_bench PRIVATE TBB::tbb)

  if(CEI3D_TESTS)
    file(GLOB tests CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/${path}/*_test.cpp)
    add_executable(cei3d_cuda_test ${tests} ${folder}/test_main.cpp ${folder}/test_heap.cpp)
    cei3d_cuda_program(cei3d_cuda_test)
    target_link_libraries(cei3d_cuda_test PRIVATE GTest::gtest)
    add_test(NAME cuda COMMAND cei3d_cuda_test WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
    set_tests_properties(cuda PROPERTIES LABELS cuda SKIP_RETURN_CODE 77)
  endif()
endfunction()
