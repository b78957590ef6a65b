"""Claims of a script: each is printed; those that do not hold make it fail. Calls of the program in a folder."""
import subprocess

failures = []


def expect(holds, what):
    print(("" if holds else "FAILED: ") + what, flush=True)
    if not holds:
        failures.append(what)


def caller(program, folder, **options):
    """@return a function that calls the program with its words in the folder, and returns what it printed"""
    return lambda *words: subprocess.run([program, *map(str, words)], capture_output=True, text=True, cwd=folder, **options)
