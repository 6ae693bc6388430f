"""The formats of exports: one module or package each, which declares its reader."""
