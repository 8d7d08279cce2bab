# SPDX-License-Identifier: Apache-2.0
# core/compute/cpu/run.cpp is compiled once per instruction set, each in its own namespace; the device picks by cpuid.
function(cei3d_instruction_sets path)
  cei3d_target_name(${path} target)
  set(source ${CMAKE_SOURCE_DIR}/src/${path}/cpu/run.cpp)
  set(isas scalar)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    list(APPEND isas ${CEI3D_X86_ISAS})
  endif()
  foreach(isa ${isas})
    string(TOUPPER ${isa} name)
    target_compile_definitions(${target} PRIVATE CEI3D_${name}=1)
  endforeach()
  set(flags_scalar "")
  set(flags_avx2 -mavx2 -mfma -mf16c)
  set(flags_avx512 -mavx512f -mavx512dq -mavx512bw -mavx512vl -mfma -mavx2 -mprefer-vector-width=512)
  set(width_scalar 1)
  set(width_avx2 8)
  set(width_avx512 16)
  foreach(isa ${isas})
    add_library(${target}_${isa} OBJECT ${source})
    target_include_directories(${target}_${isa} PRIVATE ${CMAKE_SOURCE_DIR}/src)
    # GCC 12 takes the undefined operands inside its own intrinsics headers for uninitialized variables.
    target_compile_options(${target}_${isa} PRIVATE ${CEI3D_FLAGS} $<$<CONFIG:Release>:-O3>
      $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized> -Wno-uninitialized ${flags_${isa}})
    target_compile_definitions(${target}_${isa} PRIVATE CEI3D_ISA=${isa} CEI3D_WIDTH=${width_${isa}})
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${target}_${isa}>)
  endforeach()
  find_program(NVCC nvcc HINTS /usr/local/cuda/bin)
  if(CEI3D_CUDA AND NVCC AND EXISTS ${CMAKE_SOURCE_DIR}/src/${path}/cuda/run.cu)
    file(GLOB kernels CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/${path}/kernels/*.h ${CMAKE_SOURCE_DIR}/src/core/math/*.h)
    add_custom_command(OUTPUT ${CMAKE_BINARY_DIR}/cuda_run.o
      COMMAND ${NVCC} -std=c++20 -O2 -arch=sm_90 --expt-relaxed-constexpr -I${CMAKE_SOURCE_DIR}/src -c
              ${CMAKE_SOURCE_DIR}/src/${path}/cuda/run.cu -o ${CMAKE_BINARY_DIR}/cuda_run.o
      DEPENDS ${CMAKE_SOURCE_DIR}/src/${path}/cuda/run.cu ${kernels} COMMENT "nvcc: the same kernels for CUDA")
    add_custom_target(cuda_kernels ALL DEPENDS ${CMAKE_BINARY_DIR}/cuda_run.o)
  endif()
endfunction()
