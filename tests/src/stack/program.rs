//! A linked program as its functions: what each pushes, whom it calls, whose addresses it takes.

use super::thumb::{Go, decode};
use object::read::elf::ElfFile32;
use object::{Object, ObjectSection, ObjectSymbol, RelocationTarget, SectionKind, SymbolKind, elf};
use std::collections::{BTreeMap, BTreeSet};

/// A function.
#[derive(Clone, Debug, Default)]
pub struct Function {
    /// Its names, demangled; the linker gives functions with the same code one place.
    pub names: BTreeSet<String>,
    /// Bytes of stack: what the compiler noted, or all that its code pushes.
    pub frame: u64,
    /// The functions that it calls or jumps to, by place.
    pub calls: BTreeSet<usize>,
    /// The functions whose addresses it has.
    pub takes: BTreeSet<usize>,
    /// Whether it calls by a pointer.
    pub by_pointer: bool,
}

/// The functions of a program that was linked with `--emit-relocs`, and those whose addresses lie in tables.
#[derive(Clone, Debug, Default)]
pub struct Program {
    /// In the order of their places.
    pub functions: Vec<Function>,
    /// Those whose addresses are in constant data: virtual tables.
    pub in_tables: BTreeSet<usize>,
}

impl Program {
    /// Reads an ELF file for Thumb.
    ///
    /// # Errors
    ///
    /// What is not as expected.
    pub fn read(data: &[u8]) -> Result<Self, String> {
        let file = ElfFile32::<object::Endianness>::parse(data).map_err(|e| e.to_string())?;
        let text = file.section_by_name(".text").ok_or("no .text")?;
        let code = text.data().map_err(|e| e.to_string())?;
        let mut places = BTreeMap::<u64, (u64, BTreeSet<String>)>::new();
        // "$t" and "$d" say where instructions and where data begin.
        let mut data_at = BTreeMap::<u64, bool>::new();
        for symbol in file.symbols() {
            let name = symbol.name().map_err(|e| e.to_string())?;
            if symbol.kind() == SymbolKind::Text && symbol.section_index() == Some(text.index()) {
                let place = places.entry(symbol.address() & !1).or_default();
                place.0 = place.0.max(symbol.size());
                place.1.insert(format!("{:#}", rustc_demangle::demangle(name)));
            } else if name.starts_with("$t") || name.starts_with("$d") {
                data_at.insert(symbol.address(), name.starts_with("$d"));
            }
        }
        let starts: Vec<_> = places.keys().copied().collect();
        let find = |address: u64| {
            let at = starts.partition_point(|&start| start <= address & !1).checked_sub(1)?;
            (address & !1 < starts[at] + places[&starts[at]].0).then_some(at)
        };
        let noted = frames(&file)?;

        let mut functions = Vec::new();
        for (&start, (size, names)) in &places {
            let mut function = Function { names: names.clone(), ..Function::default() };
            let name = || names.first().cloned().unwrap_or_default();
            let word = |address: u64| {
                let at = usize::try_from(address - text.address()).ok()?;
                Some(u16::from_le_bytes(code.get(at..at + 2)?.try_into().ok()?))
            };
            let (mut address, mut pushed) = (start, 0);
            while address < start + size {
                if data_at.range(..=address).next_back().is_some_and(|(_, &data)| data) {
                    address += 2;
                    continue;
                }
                let first = word(address).ok_or_else(|| format!("{}: code ends early", name()))?;
                let instruction = decode(address, first, word(address + 2).unwrap_or(0));
                pushed += instruction.pushed;
                match instruction.go {
                    Some(Go::To(target)) if !(start..start + size).contains(&target) || target == start => {
                        let target = find(target)
                            .ok_or_else(|| format!("{}: calls {target:#x}, no function", name()))?;
                        function.calls.insert(target);
                    }
                    Some(Go::Anywhere) => function.by_pointer = true,
                    _ => (),
                }
                address += instruction.bytes;
            }
            function.frame = match noted.get(&start) {
                // What was pushed and is not seen here would be missing where nothing was noted.
                Some(&frame) if frame > pushed => {
                    return Err(format!("{}: pushes {pushed}, takes {frame}", name()));
                }
                Some(&frame) => frame,
                None => pushed,
            };
            functions.push(function);
        }

        let mut in_tables = BTreeSet::new();
        for section in file.sections() {
            let loaded =
                matches!(section.kind(), SectionKind::Text | SectionKind::Data | SectionKind::ReadOnlyData);
            // Tables for unwinding name every function and call none.
            if !loaded || section.name().is_ok_and(|name| name.starts_with(".ARM.")) {
                continue;
            }
            for (offset, relocation) in section.relocations() {
                let object::RelocationFlags::Elf { r_type } = relocation.flags() else { continue };
                if matches!(r_type, elf::R_ARM_THM_PC22 | elf::R_ARM_THM_JUMP24 | elf::R_ARM_THM_JUMP19) {
                    continue;
                }
                let RelocationTarget::Symbol(index) = relocation.target() else { continue };
                let symbol = file.symbol_by_index(index).map_err(|e| e.to_string())?;
                if symbol.kind() != SymbolKind::Text {
                    continue;
                }
                let target = find(symbol.address()).ok_or("an address of no function")?;
                match find(offset).filter(|_| section.index() == text.index()) {
                    Some(user) => drop(functions[user].takes.insert(target)),
                    None => drop(in_tables.insert(target)),
                }
            }
        }
        Ok(Self { functions, in_tables })
    }
}

/// What the compiler noted of every function with `-Z emit-stack-sizes`: its place and its frame in bytes.
fn frames(file: &ElfFile32<'_>) -> Result<BTreeMap<u64, u64>, String> {
    let mut frames = BTreeMap::new();
    for section in file.sections().filter(|section| section.name() == Ok(".stack_sizes")) {
        let mut rest = section.data().map_err(|e| e.to_string())?;
        while let [a, b, c, d, after @ ..] = rest {
            let place = u64::from(u32::from_le_bytes([*a, *b, *c, *d]) & !1);
            let (mut frame, mut shift) = (0, 0);
            rest = after;
            while let [byte, after @ ..] = rest {
                frame |= u64::from(byte & 0x7f) << shift;
                shift += 7;
                rest = after;
                if byte & 0x80 == 0 {
                    break;
                }
            }
            let most: &mut u64 = frames.entry(place).or_default();
            *most = frame.max(*most);
        }
    }
    if frames.is_empty() {
        Err("no .stack_sizes: built without -Z emit-stack-sizes".into())
    } else {
        Ok(frames)
    }
}
