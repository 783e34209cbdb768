"""Says that the package holds a compiled module, for which pyproject.toml has no key."""

from setuptools import Distribution, setup


class WithModule(Distribution):
    def has_ext_modules(self) -> bool:
        return True


setup(distclass=WithModule)
