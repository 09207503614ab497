"""Loads a program of the fleet, whose file has no extension, as a module."""
import importlib.machinery
import importlib.util


def program(path):
    loader = importlib.machinery.SourceFileLoader(path.name, str(path))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(path.name, loader))
    loader.exec_module(module)
    return module
