# FindCHOLMOD: CHOLMOD of SuiteSparse. Defines the target SuiteSparse::CHOLMOD.
include(SuiteSparseLibrary)
snare_find_suitesparse(CHOLMOD camd ccolamd colamd amd)
