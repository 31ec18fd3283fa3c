//! What the compiler must know, and what can be left until the program runs.
//!
//! A constant function can be an ordinary one where no array's length, no pattern, no generic argument and no public
//! constant needs it; the statics and constants that call it are then computed when they are first used. Names decide,
//! on the safe side: of two things of one name both stay constant if one must.

use crate::edit::{Edits, Piece};
use proc_macro2::Span;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{Expr, Token, punctuated::Punctuated};

/// A constant thing: a function, a constant or a static.
struct Thing {
    path: String,
    /// The type whose associated function it is.
    of: Option<String>,
    name: String,
    function: bool,
    /// A static never stands where the compiler must know it.
    is_static: bool,
    public: bool,
    /// Other files can name it.
    seen: bool,
    uses: BTreeSet<Use>,
    range: Range<usize>,
}

/// A name in an expression, with what stands before it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Use {
    Path(Option<String>, String),
    Method(String),
}

impl Thing {
    fn is_meant(&self, used: &Use) -> bool {
        match used {
            Use::Method(name) => self.of.is_some() && self.name == *name,
            Use::Path(of, name) if self.name == *name => match (of, &self.of) {
                (Some(of), Some(own)) => of == "Self" || of == own,
                (Some(of), None) => of.starts_with(char::is_lowercase),
                (None, own) => own.is_none(),
            },
            Use::Path(..) => false,
        }
    }
}

/// What stays constant and what becomes lazy, by file and name.
#[derive(Default)]
pub struct Constants {
    /// Functions that stay constant.
    kept: BTreeSet<(String, Option<String>, String)>,
    lazy: BTreeSet<(String, String)>,
    /// All constants and statics by name: the files, and whether other files see them.
    by_name: BTreeMap<String, Vec<(String, bool)>>,
}

impl Constants {
    /// Looks through the kernel's files (path, syntax, the bytes where mutants are) and through those that use it.
    pub fn of(kernel: &[(&str, &syn::File, Vec<usize>)], others: &[syn::File]) -> Self {
        let mut things = Vec::new();
        let mut needed = BTreeSet::new();
        for (path, syntax, _) in kernel {
            let mut finder = Finder { path, of: None, things: &mut things, needed: &mut needed };
            finder.visit_file(syntax);
        }
        for syntax in others {
            let mut theirs = Vec::new();
            let mut finder = Finder { path: "", of: None, things: &mut theirs, needed: &mut needed };
            finder.visit_file(syntax);
            for thing in theirs {
                needed.extend(thing.uses);
            }
        }
        needed.extend(
            things.iter().filter(|t| t.public && !t.function && !t.is_static).flat_map(|t| t.uses.clone()),
        );
        let hard = closure(&things, needed);
        let lazy = lazy(&things, &hard, kernel);
        let mut constants = Self::default();
        for (index, thing) in things.iter().enumerate() {
            if thing.function {
                if hard.contains(&index) {
                    constants.kept.insert((thing.path.clone(), thing.of.clone(), thing.name.clone()));
                }
                continue;
            }
            let seen = constants.by_name.entry(thing.name.clone()).or_default();
            seen.push((thing.path.clone(), thing.seen));
            if lazy.contains(&index) {
                constants.lazy.insert((thing.path.clone(), thing.name.clone()));
            }
        }
        constants
    }

    /// Whether a function may ask which mutant is active; takes away its `const`.
    pub fn frees(&self, signature: &syn::Signature, of: Option<&str>, path: &str, edits: &mut Edits) -> bool {
        let Some(token) = signature.constness else { return true };
        let key = (path.to_owned(), of.map(str::to_owned), signature.ident.to_string());
        if self.kept.contains(&key) {
            return false;
        }
        edits.replace(token.span.byte_range(), "");
        true
    }

    /// Whether a constant or static may be computed when it is first used; makes it so.
    pub fn makes_lazy(
        &self,
        (name, token): (&syn::Ident, Span),
        (kind, value): (&syn::Type, &Expr),
        path: &str,
        edits: &mut Edits,
    ) -> bool {
        if !self.lazy.contains(&(path.to_owned(), name.to_string())) {
            return false;
        }
        let mut insert = |at: usize, what: &str| edits.insert(at, Vec::new(), vec![Piece::Text(what.into())]);
        insert(kind.span().byte_range().start, "::std::sync::LazyLock<");
        insert(kind.span().byte_range().end, ">");
        insert(value.span().byte_range().start, "::std::sync::LazyLock::new(|| ");
        insert(value.span().byte_range().end, ")");
        edits.replace(token.byte_range(), "static");
        true
    }

    /// Whether this name in an expression is that of something lazy.
    pub fn is_lazy(&self, path: &syn::Path, file: &str) -> bool {
        let Some(name) = path.segments.last().map(|segment| segment.ident.to_string()) else { return false };
        let Some(seen) = self.by_name.get(&name) else { return false };
        let is_lazy = |of: &str| self.lazy.contains(&(of.to_owned(), name.clone()));
        if path.segments.len() == 1 && seen.iter().any(|(of, _)| of == file) {
            return is_lazy(file);
        }
        // What stands before it is a module: a type's constants stay what they are.
        let mut before = path.segments.iter().rev().skip(1).map(|segment| segment.ident.to_string());
        let in_type = before.next().is_some_and(|module| module.starts_with(char::is_uppercase));
        !in_type && seen.iter().any(|(of, seen)| of != file && *seen && is_lazy(of))
    }
}

/// The numbers of the things that are needed, and of what these need.
fn closure(things: &[Thing], mut needed: BTreeSet<Use>) -> BTreeSet<usize> {
    let mut hard = BTreeSet::new();
    loop {
        let more: Vec<usize> = (0..things.len())
            .filter(|index| !hard.contains(index) && needed.iter().any(|used| things[*index].is_meant(used)))
            .collect();
        if more.is_empty() {
            return hard;
        }
        for index in more {
            hard.insert(index);
            needed.extend(things[index].uses.clone());
        }
    }
}

/// The numbers of the constants and statics that become lazy: they have mutants, or use what is not constant any more.
fn lazy(
    things: &[Thing],
    hard: &BTreeSet<usize>,
    kernel: &[(&str, &syn::File, Vec<usize>)],
) -> BTreeSet<usize> {
    let has_mutants = |thing: &Thing| {
        let of_file = kernel.iter().filter(|(path, ..)| *path == thing.path);
        of_file.flat_map(|(.., places)| places).any(|place| thing.range.contains(place))
    };
    let free = |index: &usize| things[*index].is_static || !hard.contains(index) && !things[*index].public;
    let mut found: BTreeSet<usize> = (0..things.len())
        .filter(|index| !things[*index].function && free(index) && has_mutants(&things[*index]))
        .collect();
    loop {
        let changed = |used: &Use| {
            things.iter().enumerate().any(|(other, thing)| {
                thing.is_meant(used)
                    && if thing.function { !hard.contains(&other) } else { found.contains(&other) }
            })
        };
        let more: Vec<usize> = (0..things.len())
            .filter(|index| !things[*index].function && free(index) && !found.contains(index))
            .filter(|index| things[*index].uses.iter().any(changed))
            .collect();
        if more.is_empty() {
            return found;
        }
        found.extend(more);
    }
}

/// The name of the type that an `impl` is of.
pub fn own_type(item: &syn::ItemImpl) -> Option<String> {
    match item.self_ty.as_ref() {
        syn::Type::Path(kind) => kind.path.segments.last().map(|segment| segment.ident.to_string()),
        _ => None,
    }
}

struct Finder<'a> {
    path: &'a str,
    of: Option<String>,
    things: &'a mut Vec<Thing>,
    needed: &'a mut BTreeSet<Use>,
}

/// The names in a part of the syntax.
#[derive(Default)]
struct Uses(BTreeSet<Use>);

impl Uses {
    fn name(&mut self, path: &syn::Path) {
        let mut names = path.segments.iter().rev().map(|segment| segment.ident.to_string());
        if let Some(name) = names.next() {
            self.0.insert(Use::Path(names.next(), name));
        }
    }
}

impl<'ast> Visit<'ast> for Uses {
    fn visit_path(&mut self, path: &'ast syn::Path) {
        // A small name alone is a variable's, unless it is called.
        if path.segments.len() > 1
            || path.segments.iter().any(|s| s.ident.to_string().starts_with(char::is_uppercase))
        {
            self.name(path);
        }
        visit::visit_path(self, path);
    }

    fn visit_expr_call(&mut self, call: &'ast syn::ExprCall) {
        if let Expr::Path(function) = call.func.as_ref() {
            self.name(&function.path);
        }
        visit::visit_expr_call(self, call);
    }

    fn visit_expr_method_call(&mut self, call: &'ast syn::ExprMethodCall) {
        self.0.insert(Use::Method(call.method.to_string()));
        visit::visit_expr_method_call(self, call);
    }

    fn visit_pat_ident(&mut self, pattern: &'ast syn::PatIdent) {
        let name = pattern.ident.to_string();
        if !name.contains(char::is_lowercase) {
            self.0.insert(Use::Path(None, name));
        }
    }

    fn visit_macro(&mut self, item: &'ast syn::Macro) {
        if let Ok(arguments) = item.parse_body_with(Punctuated::<Expr, Token![,]>::parse_terminated) {
            arguments.iter().for_each(|argument| self.visit_expr(argument));
        }
    }
}

fn uses(visit: impl FnOnce(&mut Uses)) -> BTreeSet<Use> {
    let mut uses = Uses::default();
    visit(&mut uses);
    uses.0
}

impl Finder<'_> {
    fn function(&mut self, signature: &syn::Signature, block: &syn::Block, visibility: &syn::Visibility) {
        if signature.constness.is_some() {
            let uses = uses(|uses| uses.visit_block(block));
            self.thing(&signature.ident, true, false, visibility, uses, block.span());
        }
    }

    fn thing(
        &mut self,
        name: &syn::Ident,
        function: bool,
        is_static: bool,
        visibility: &syn::Visibility,
        uses: BTreeSet<Use>,
        span: Span,
    ) {
        let public = matches!(visibility, syn::Visibility::Public(_));
        let seen = !matches!(visibility, syn::Visibility::Inherited);
        let (path, of, name) = (self.path.to_owned(), self.of.clone().filter(|_| function), name.to_string());
        self.things.push(Thing {
            path,
            of,
            name,
            function,
            is_static,
            public,
            seen,
            uses,
            range: span.byte_range(),
        });
    }

    fn needs(&mut self, visit: impl FnOnce(&mut Uses)) {
        self.needed.extend(uses(visit));
    }
}

impl<'ast> Visit<'ast> for Finder<'_> {
    fn visit_item_impl(&mut self, item: &'ast syn::ItemImpl) {
        let outside = std::mem::replace(&mut self.of, own_type(item));
        visit::visit_item_impl(self, item);
        self.of = outside;
    }

    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        self.function(&item.sig, &item.block, &item.vis);
        visit::visit_item_fn(self, item);
    }

    fn visit_impl_item_fn(&mut self, item: &'ast syn::ImplItemFn) {
        self.function(&item.sig, &item.block, &item.vis);
        visit::visit_impl_item_fn(self, item);
    }

    fn visit_item_const(&mut self, item: &'ast syn::ItemConst) {
        let uses = uses(|uses| uses.visit_expr(&item.expr));
        self.thing(&item.ident, false, false, &item.vis, uses, item.expr.span());
        visit::visit_item_const(self, item);
    }

    fn visit_item_static(&mut self, item: &'ast syn::ItemStatic) {
        let uses = uses(|uses| uses.visit_expr(&item.expr));
        self.thing(&item.ident, false, true, &item.vis, uses, item.expr.span());
        visit::visit_item_static(self, item);
    }

    fn visit_impl_item_const(&mut self, item: &'ast syn::ImplItemConst) {
        self.needs(|uses| uses.visit_expr(&item.expr));
    }

    fn visit_trait_item_const(&mut self, item: &'ast syn::TraitItemConst) {
        self.needs(|uses| uses.visit_trait_item_const(item));
    }

    fn visit_type_array(&mut self, array: &'ast syn::TypeArray) {
        self.needs(|uses| uses.visit_expr(&array.len));
        visit::visit_type_array(self, array);
    }

    fn visit_expr_repeat(&mut self, repeat: &'ast syn::ExprRepeat) {
        self.needs(|uses| uses.visit_expr(&repeat.len));
        visit::visit_expr_repeat(self, repeat);
    }

    fn visit_generic_argument(&mut self, argument: &'ast syn::GenericArgument) {
        self.needs(|uses| uses.visit_generic_argument(argument));
        visit::visit_generic_argument(self, argument);
    }

    fn visit_expr_const(&mut self, block: &'ast syn::ExprConst) {
        // In the kernel it becomes an ordinary block.
        if self.path.is_empty() {
            self.needs(|uses| uses.visit_expr_const(block));
        }
        visit::visit_expr_const(self, block);
    }

    fn visit_pat(&mut self, pattern: &'ast syn::Pat) {
        self.needs(|uses| uses.visit_pat(pattern));
    }

    fn visit_variant(&mut self, variant: &'ast syn::Variant) {
        self.needs(|uses| uses.visit_variant(variant));
    }
}
