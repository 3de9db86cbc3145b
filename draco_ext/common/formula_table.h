// Tables that follow from a formula: the compiler makes them, or the program at its start, where bytes count for more (LACERTA_TERSE).
#ifndef LACERTA_COMMON_FORMULA_TABLE_H_
#define LACERTA_COMMON_FORMULA_TABLE_H_

#ifdef LACERTA_TERSE
#define LACERTA_FORMULA_TABLE
#else
#define LACERTA_FORMULA_TABLE constexpr
#endif

#endif  // LACERTA_COMMON_FORMULA_TABLE_H_
